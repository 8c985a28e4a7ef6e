# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a study of doc/accuracy.md consists of."""


class Quantity:
    """What is judged: a column of the history, or the mean of a field over a
    window of the plane, at a time."""

    def __init__(self, name, unit, column=None, field=None, window=None, scale=1.0):
        self.name, self.unit, self.column = name, unit, column
        self.field, self.window, self.scale = field, window, scale


class Study:
    def __init__(self, name, title, scene, time, base, quantities):
        self.name, self.title, self.scene, self.time = name, title, scene, time
        self.base, self.quantities = base, quantities
        self.runs = []      # (knob, value, scene, settings)
        self.meshes = []    # (run, relative cell size) from coarse to fine
        self.mesh_order = 2.0 # expected
        self.steps = []     # (run, step) from long to short
        self.base_run = None  # the run that both series go through
        self.diagrams = {}  # name: knobs

    def knob(self, knob, values):
        """values: {label: settings}, added to the base."""
        for label, settings in values.items():
            self.runs.append((knob, label, self.scene, self.base + settings))

    def other(self, knob, label, scene, settings):
        self.runs.append((knob, label, scene, settings))


def steps(value):
    return [f"Time/Initial step={value}", f"Time/Maximum step={value}"]
