# SPDX-License-Identifier: LGPL-2.1-or-later
"""The accuracy levels of the small scenes and of the incisor in three dimensions.
Reference: better meshes and shorter steps of the same scene, extrapolated."""
from study import Quantity, Study, steps


def scene_levels(study, end):
    for level in ("fast", "balanced", "reference"):
        study.other("level", level, study.scene, end + ["Accuracy=" + level])


def series(study, name, meshes, order, lengths, common, base):
    """Meshes {label: (settings, relative size)} at the step @p base, and steps on
    the mesh of base, both with the settings @p common."""
    step, mesh = base
    study.knob("mesh", {label: common + settings + steps(step)
                        for label, (settings, _) in meshes.items()})
    study.knob("step", {s: common + meshes[mesh][0] + steps(s) for s in lengths if s != step})
    study.meshes = [(("mesh", label), size) for label, (_, size) in meshes.items()]
    study.mesh_order = order
    study.steps = [(("mesh", mesh) if s == step else ("step", s), float(s)) for s in lengths]
    study.base_run = ("mesh", mesh)
    study.title = name
    return study


def refined(numbers):
    return {n: ([f"Mesh/grid generator/Refinements={n}"], 2.0 ** -int(n)) for n in numbers}


def pressurised_ring():
    end = ["Output/Fields=false"]
    study = Study("levels-ring", "", "pressurised-ring", 1, end,
                  [Quantity("radial displacement", "mm", "east: displacement x"),
                   Quantity("stored energy", "mJ", "stored energy")])
    scene_levels(study, end)
    return series(study, "Pressurised ring: levels", refined("0123"), 4.0,
                  ("0.2", "0.1", "0.05"), ["Mesh/Degree=2"], ("0.1", "2"))


def punch():
    end = ["Output/Fields=false"]
    study = Study("levels-punch", "", "punch", 1, end,
                  [Quantity("force", "N", "punch: force y"),
                   Quantity("stored energy", "mJ", "stored energy")])
    scene_levels(study, end)
    # the edge of the punch is singular
    return series(study, "Punch: levels", refined("0123"), 1.0, ("0.25", "0.1", "0.05"),
                  ["Mesh/Degree=2"], ("0.1", "1"))


def disc_in_ring():
    end = ["Output/Fields=false"]
    study = Study("levels-disc", "", "disc-in-ring", 1, end,
                  [Quantity("force", "N", "force x"), Quantity("moment", "N mm", "moment"),
                   Quantity("stored energy", "mJ", "stored energy")])
    scene_levels(study, end)
    return series(study, "Disc in a ring: levels", refined("1234"), 2.0,
                  ("0.05", "0.025", "0.0125"), ["Transfer/Scheme=limited linear"],
                  ("0.025", "2"))


def own_outline():
    end = ["Output/Fields=false"]
    mesh = "Mesh/tooth in socket/"
    study = Study("levels-own-outline", "", "own-outline", 1, end,
                  [Quantity("tip", "mm", "tip: displacement"),
                   Quantity("rotation", "degree", "tooth: rotation"),
                   Quantity("stored energy", "mJ", "stored energy")])
    scene_levels(study, end)
    return series(study, "Own outline: levels",
                  {n: ([mesh + f"Refinement={n}"], 1 / int(n)) for n in "123"}, 2.0,
                  ("0.2", "0.1", "0.05"), [], ("0.1", "1"))


def incisor_3d():
    # Under the force alone: later the couple turns the tooth back to no rotation
    end = ["Output/Fields=false"]
    study = Study("levels-incisor-3d", "", "incisor-3d", 1, end,
                  [Quantity("edge", "mm", "edge: displacement x"),
                   Quantity("rotation", "degree", "tooth: rotation z"),
                   Quantity("stored energy", "mJ", "stored energy")])
    study.other("level", "fast", study.scene, end + ["Accuracy=fast"])
    study.other("level", "balanced", study.scene, end + ["Accuracy=balanced"])
    meshes = {d: ([f"Mesh/incisor/Mesh density={d}"], float(d) ** (-1 / 3))
              for d in ("0.06", "0.12", "0.25", "0.5", "1", "2")}
    study.knob("degree 2", {d: ["Mesh/Degree=2", "Time/End=1"] + meshes[d][0] + steps("0.5")
                            for d in ("0.06", "0.12")})
    return series(study, "Incisor in 3D: levels", meshes, 2.0, ("1", "0.5", "0.25"), [],
                  ("0.5", "0.12"))


def all_of_them():
    return (pressurised_ring(), punch(), disc_in_ring(), own_outline(), incisor_3d())
