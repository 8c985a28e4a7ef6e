# SPDX-License-Identifier: LGPL-2.1-or-later
"""Necking of a bar in plane strain."""
import math

from book import case
from elasticity import steps

E, NU, YIELD, Q, RATE, H = 206900.0, 0.29, 450.0, 265.0, 16.93, 129.24
MU, BULK = E / (2 * (1 + NU)), E / (3 * (1 - 2 * NU))


def yield_stress(alpha):
    return YIELD + Q * (1 - math.exp(-RATE * alpha)) + H * alpha


def slope(alpha):
    return Q * RATE * math.exp(-RATE * alpha) + H


def uniform(end, n):
    """Kirchhoff stress tau of a bar of J2 plasticity in plane strain, free at its
    sides, over the logarithmic strain e: the rate equations in the Hencky strains
    (tau_22 = 0, e_33 = 0) by the classical Runge-Kutta method from first yield on.
    Returns lists of e and tau."""
    # Elastic: s = E/(1-nu^2) e along, nu s across
    q = math.sqrt(1 - NU + NU * NU)
    s1 = YIELD / q
    state = (s1, NU * s1, 0.0)  # tau_11, tau_33, alpha
    e = s1 * (1 - NU * NU) / E

    def rates(s):
        t1, t3, alpha = s
        q = math.sqrt(t1 * t1 - t1 * t3 + t3 * t3)
        n1, n3 = (t1 - t3 / 2) / q, (t3 - t1 / 2) / q
        # de = dtau1/E - nu dtau3/E + n1 g;  0 = dtau3/E - nu dtau1/E + n3 g;
        # n1 dtau1 + n3 dtau3 = k' g
        # with dtau from the first two: C ((1, 0) - g n), C plane stress in 1, 3
        c = E / (1 - NU * NU)
        Cn1, Cn3 = c * (n1 + NU * n3), c * (n3 + NU * n1)
        g = (n1 * c + n3 * c * NU) / (n1 * Cn1 + n3 * Cn3 + slope(alpha))
        return c - g * Cn1, c * NU - g * Cn3, g

    def step(s, h):
        def moved(k, f):
            return tuple(a + f * b for a, b in zip(s, k))
        k1 = rates(s)
        k2 = rates(moved(k1, h / 2))
        k3 = rates(moved(k2, h / 2))
        k4 = rates(moved(k3, h))
        return tuple(a + h / 6 * (p + 2 * q + 2 * r + t)
                     for a, p, q, r, t in zip(s, k1, k2, k3, k4))

    # The direction of flow turns quickly just after first yield: graded steps
    strains, stresses, first = [e], [s1], e
    for i in range(1, n + 1):
        new = first + (end - first) * (i / n) ** 2
        state = step(state, new - e)
        e = new
        strains.append(e)
        stresses.append(state[0])
    return strains, stresses


def interpolate(x, y, at):
    for i in range(1, len(x)):
        if x[i] >= at:
            f = (at - x[i - 1]) / (x[i] - x[i - 1])
            return y[i - 1] + f * (y[i] - y[i - 1])
    raise ValueError("beyond the end")


def largest(x, y):
    """Maximum of the parabola through the three points around the largest."""
    i = min(max(range(len(y)), key=y.__getitem__), len(y) - 2)
    (x0, x1, x2), (y0, y1, y2) = x[i - 1:i + 2], y[i - 1:i + 2]
    a = ((y2 - y1) / (x2 - x1) - (y1 - y0) / (x1 - x0)) / (x2 - x0)
    b = (y1 - y0) / (x1 - x0) + a * (x1 - x0)
    return x1 - b / (2 * a), y1 - b * b / (4 * a)


@case("Necking of a bar in plane strain", short=False)
def necking(book):
    e, tau = uniform(0.15, 4000)
    half, width = 26.667, 6.413
    force = [width * t / math.exp(x) for x, t in zip(e, tau)]
    e_max, f_max = largest(e, force)
    # Rigid-plastic: d tau/d e = tau with tau = (2/sqrt 3) y, alpha = (2/sqrt 3) e
    alpha = 0.1
    for _ in range(100):  # y'(alpha) = (sqrt 3/2) y(alpha), Newton's method
        value = slope(alpha) - math.sqrt(0.75) * yield_stress(alpha)
        alpha -= value / (-Q * RATE * RATE * math.exp(-RATE * alpha)
                          - math.sqrt(0.75) * slope(alpha))
    e_rigid = math.sqrt(0.75) * alpha
    f_rigid = width * math.sqrt(4 / 3) * yield_stress(alpha) / math.exp(e_rigid)
    book.near("largest load per mm of the integrated bar [N]", f_rigid,
              "Considère, rigid-plastic: dτ/dε = τ", f_max, 5e-3)
    book.measured("its logarithmic strain", e_max, e_rigid, "Considère, rigid-plastic",
                  e_max / e_rigid - 1)

    # The program on a uniform bar: three step sizes, before and at the maximum
    even = ["Mesh/grid generator/Map=x; y", "Mesh/grid generator/Arguments=2, 1 : 0, 0 : "
            "26.667, 6.413 : true",
            "Mesh/grid generator/Point names=neck: 0, 6.413; end: 26.667, 6.413"]
    column = "grip: force x [N]"

    def curve(run):
        return ([math.log(1 + 4.26672 * t / half) for t in run.history["time [T]"]],
                [abs(f) for f in run.history[column]])

    ks = book.levels((0, 1, 2, 3, 4, 5), (0, 1, 2))
    runs = [curve(book.run("necking", even + steps(0.02 / 2**k))) for k in ks]
    source = "rate equations of the uniform bar, Runge–Kutta"
    at = math.log(1 + 4.26672 * 0.3 / half)
    book.converging("force at 4.8 % elongation, before the maximum, uniform bar, steps "
                    "of 0.32 % halved [N]", interpolate(e, force, at), source,
                    [interpolate(*r, at) for r in runs], 0.9, 1e-3)
    peaks = [largest(*r) for r in runs]
    book.converging("largest load, uniform bar [N]", f_max, "Considère: dτ/dε = τ "
                    "on the integrated curve", [p[1] for p in peaks], 0.9, 1e-3)
    book.near("logarithmic strain there", e_max, "Considère", peaks[-1][0], 1e-2)

    # Slightly narrower in the middle: it necks after the maximum
    meshes = book.levels(((20, 10), (40, 20)), ((20, 10),))
    for nx, ny in meshes:
        run = book.run("necking", steps(0.01) + [
            f"Mesh/grid generator/Arguments={nx}, {ny} : 0, 0 : 26.667, 6.413 : true"])
        x, y = curve(run)
        strain, load = largest(x, y)
        name = f"bar narrower by 0.1 %, {nx} × {ny} elements"
        # The neck carries less by its own area, no more
        book.near(f"{name}: largest load [N]", f_max, "Considère, uniform bar", load, 2e-3)
        neck, end = (abs(run.last(f"{p}: displacement y [mm]")) for p in ("neck", "end"))
        book.measured(f"{name}: logarithmic strain there", strain, e_max, "Considère",
                      strain / e_max - 1)
        book.measured(f"{name}: half width of neck and of end at 16 % [mm]",
                      f"{6.406587 - neck:.4f} and {width - end:.4f}")
        i = max(range(len(y)), key=y.__getitem__)
        early = [abs(f / interpolate(e, force, s) - 1)
                 for s, f in zip(x[:i // 2], y[:i // 2]) if s > 0.01]
        book.add(f"{name}: largest relative difference of the force to the uniform bar "
                 "before half the strain of the maximum", 0.0, source, max(early),
                 max(early), None, "≤ 0.002", max(early) <= 2e-3)
        book.measured(f"{name}: force at 16 % over the largest", y[-1] / load)
