# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits of series by Richardson's extrapolation, with error bars.

Three values q1, q2, q3 on meshes (or with steps) h1 > h2 > h3 determine the limit
q and the observed order p of q_i = q + c h_i^p. Three cases:

* p is between half and one and a half times the expected order: the limit is q,
  its error bar the grid convergence index (Roache 1994), 1.25 |q - q3|, and not
  less than the distance from the limit of the three values before, if there is
  one;
* the values come closer in one direction, with another order, or there are only
  two: the expected order is assumed, and the error bar is 3 |q - q3|;
* they go to and fro (other meshes have other nodes): the limit is q3, the error
  bar the range of the three.
"""
import math


class Limit:
    def __init__(self, value, error, order, kind):
        self.value, self.error = value, error
        self.order, self.kind = order, kind


def observed_order(h, q):
    """p of three values, or None."""
    a, b = q[0] - q[1], q[1] - q[2]
    if a * b <= 0 or abs(b) >= abs(a):
        return None

    def difference(p):
        return (h[0] ** p - h[1] ** p) / (h[1] ** p - h[2] ** p) - a / b
    low, high = 0.05, 12.0
    if difference(low) * difference(high) > 0:
        return None
    for _ in range(100):
        middle = 0.5 * (low + high)
        if difference(low) * difference(middle) <= 0:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def extrapolated(h, q, expected):
    """Limit of the last three of a series, from coarse to fine."""
    h, q = h[-3:], q[-3:]
    if len(q) == 3 and (q[0] - q[1]) * (q[1] - q[2]) <= 0:
        return Limit(q[-1], max(q) - min(q), None, "to and fro")
    order = observed_order(h, q) if len(q) == 3 else None
    seen = order is not None and 0.5 * expected <= order <= 1.5 * expected
    p = order if seen else expected
    value = q[-1] + (q[-1] - q[-2]) / ((h[-2] / h[-1]) ** p - 1)
    return Limit(value, (1.25 if seen else 3.0) * abs(value - q[-1]), p,
                 "observed" if seen else "assumed")


def limit(h, q, expected):
    best = extrapolated(h, q, expected)
    if len(q) > 3 and best.kind == "observed":
        before = extrapolated(h[:-1], q[:-1], expected)
        if before.kind == "observed":
            best.error = max(best.error, abs(best.value - before.value))
    return best


def combined(mesh, step, base):
    """Limit in mesh and step together: that of the mesh, corrected by what the
    step changes of the run that both series have in common, @p base; error bars
    add up."""
    return Limit(mesh.value + step.value - base, mesh.error + step.error, mesh.order,
                 f"mesh {mesh.kind}, step {step.kind}")


def relative(value, reference):
    return abs(value - reference) / abs(reference) if reference else math.nan
