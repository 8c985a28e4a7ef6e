# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the meshes and fields that alveolus has written.

render.py NAME OUTPUT_ROOT draws OUTPUT_ROOT/NAME into OUTPUT_ROOT/figures: for
`academic` the counterparts of the paper's figures, otherwise the last mesh.
Needs python3-vtk9 and a display (xvfb-run).
"""
import math
import os
import re
import sys
import xml.etree.ElementTree

try:
    import vtk
except ImportError:
    sys.exit("render.py: no VTK; run scripts/install-dependencies figures")

WIDTH = 1600  # pixels
BLACK, GREY = (0.0, 0.0, 0.0), (0.75, 0.75, 0.75)
LABELS = {
    "stimulus": "criterion: signed energy density [MPa]",
    "density": "apparent density [g/cc]",
    "scaled_Jacobian": "scaled Jacobian [-]",
    "von_Mises_stress": "von Mises stress [MPa]",
    "region": "region",
}
DIVERGING = [(0.0, 0.10, 0.25, 0.60), (0.25, 0.45, 0.65, 0.88),
             (0.5, 0.97, 0.97, 0.97), (0.75, 0.93, 0.55, 0.42),
             (1.0, 0.65, 0.05, 0.10)]
SEQUENTIAL = [(0.0, 0.27, 0.00, 0.33), (0.25, 0.23, 0.32, 0.55),
              (0.5, 0.13, 0.57, 0.55), (0.75, 0.37, 0.79, 0.38),
              (1.0, 0.99, 0.91, 0.15)]
REGIONS = [(0.0, 0.78, 0.86, 0.94), (0.5, 0.99, 0.92, 0.76),
           (1.0, 0.80, 0.92, 0.77)]


class Missing(Exception):
    """Something the picture needs is not there."""


# Results


def states(folder):
    """Times and files of a run, in order."""
    name = os.path.join(folder, "fields.pvd")
    if not os.path.exists(name):
        raise Missing(f"there is no {name}; run the scene with Output / Fields")
    entries = xml.etree.ElementTree.parse(name).iter("DataSet")
    result = [(float(e.get("timestep")), os.path.join(folder, e.get("file")))
              for e in entries]
    if not result:
        raise Missing(f"{name} lists no state")
    return result


def nearest(all_states, time):
    return min(all_states, key=lambda state: abs(state[0] - time))


def read(name):
    if not os.path.exists(name):
        raise Missing(f"there is no {name}")
    parallel = name.endswith(".pvtu")
    reader = (vtk.vtkXMLPUnstructuredGridReader() if parallel
              else vtk.vtkXMLUnstructuredGridReader())
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfCells() == 0:
        raise Missing(f"{name} has no cells")
    return grid


def values_of(grid, field):
    """The array of a field; deal.II writes cell data at the cells' points."""
    for data in (grid.GetPointData(), grid.GetCellData()):
        if data.HasArray(field):
            return data, data.GetArray(field)
    raise Missing(f"the results have no field {field}")


def finite_values(grid, field, window=None):
    """Finite values, sorted; only of cells within the window if given."""
    data, array = values_of(grid, field)
    at_points = data is grid.GetPointData()
    result = []
    for c in range(grid.GetNumberOfCells()):
        ids = grid.GetCell(c).GetPointIds()
        first = ids.GetId(0)
        if window and not inside(grid.GetPoint(first), window):
            continue
        value = array.GetValue(first if at_points else c)
        if math.isfinite(value):
            result.append(value)
    return sorted(result)


def inside(point, window):
    return (window[0] <= point[0] <= window[1]
            and window[2] <= point[1] <= window[3])


def quantile(values, part):
    return values[round(part * (len(values) - 1))]


def symmetric_range(grids, field, window):
    """+-98 % quantile, so that single peaks do not wash out the rest."""
    values = sorted(abs(v) for g in grids
                    for v in finite_values(g, field, window))
    if not values:
        raise Missing(f"{field} has no finite value")
    bound = quantile(values, 0.98) or 1.0
    digits = 10 ** math.floor(math.log10(bound))
    bound = math.ceil(2 * bound / digits) * digits / 2
    return (-bound, bound)


def bounds(grids):
    boxes = [g.GetBounds() for g in grids]
    return (min(b[0] for b in boxes), max(b[1] for b in boxes),
            min(b[2] for b in boxes), max(b[3] for b in boxes))


# Pictures


def colours(points, interval):
    function = vtk.vtkColorTransferFunction()
    for p in points:
        function.AddRGBPoint(*p)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for i in range(256):
        table.SetTableValue(i, *function.GetColor(i / 255), 1.0)
    table.SetNanColor(*GREY, 1.0)
    table.SetRange(*interval)
    return table


def mesh_actors(grid, field, table):
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputData(grid)
    data, _ = values_of(grid, field)
    mapper.SelectColorArray(field)
    if data is grid.GetPointData():
        mapper.SetScalarModeToUsePointFieldData()
    else:
        mapper.SetScalarModeToUseCellFieldData()
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    return [actor, edge_actor(grid)]


def edge_actor(grid):
    """Edges as lines of their own; those of the surface show its triangles."""
    edges = vtk.vtkExtractEdges()
    edges.SetInputData(grid)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    if grid.GetBounds()[5] - grid.GetBounds()[4] < 1e-9:
        actor.SetPosition(0, 0, 0.5)  # before the cells, seen from above
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetColor(0.15, 0.15, 0.15)
    actor.GetProperty().SetLineWidth(1.2)
    return actor


def text_actor(text, size, x, y, anchor="left"):
    """Text at x, y in parts of its viewport."""
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    style(actor.GetTextProperty(), size)
    if anchor == "centre":
        actor.GetTextProperty().SetJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    return actor


def style(properties, size):
    properties.SetFontFamilyToArial()
    properties.SetFontSize(size)
    properties.SetColor(*BLACK)
    properties.ItalicOff()
    properties.BoldOff()
    properties.ShadowOff()


class Picture:
    """Panels of equal width above each other, each with a title and a window of
    the plane to show, and one colour bar below."""

    TITLE, BAR, MARGIN = 56, 150, 20  # pixels

    def __init__(self, windows, bar=True, three_d=False):
        self.three_d = three_d
        self.heights = [
            int((WIDTH - 2 * self.MARGIN) * (w[3] - w[2]) / (w[1] - w[0]))
            for w in windows]
        # A tall window is not drawn larger than fits a screen or two.
        self.scale = min(1.0, 2200 / sum(self.heights))
        self.heights = [int(h * self.scale) for h in self.heights]
        self.windows = windows
        self.bar = self.BAR if bar else self.MARGIN
        self.height = sum(h + self.TITLE for h in self.heights) + self.bar
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(8)
        self.window.SetSize(WIDTH, self.height)
        self.add_viewport(0, self.height)  # white ground
        self.top = self.height
        self.n = 0

    def add_viewport(self, bottom, height):
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(0, bottom / self.height, 1,
                             (bottom + height) / self.height)
        self.window.AddRenderer(renderer)
        return renderer

    def panel(self, title, actors):
        height, window = self.heights[self.n], self.windows[self.n]
        head = self.add_viewport(self.top - self.TITLE, self.TITLE)
        head.AddViewProp(text_actor(title, 32, 0.5, 0.2, "centre"))
        self.top -= self.TITLE + height
        renderer = self.add_viewport(self.top, height)
        for actor in actors:
            renderer.AddViewProp(actor)
        camera = renderer.GetActiveCamera()
        if self.three_d:
            camera.SetPosition(1, -2, 1)
            camera.SetViewUp(0, 0, 1)
            renderer.ResetCamera()
        else:
            x, y = (window[0] + window[1]) / 2, (window[2] + window[3]) / 2
            camera.ParallelProjectionOn()
            camera.SetFocalPoint(x, y, 0)
            camera.SetPosition(x, y, 1000)
            camera.SetParallelScale((window[3] - window[2]) / 2 * 1.01)
            renderer.ResetCameraClippingRange()
        self.n += 1
        return renderer

    def colour_bar(self, table, label, n_labels=5):
        renderer = self.add_viewport(0, self.BAR)
        bar = vtk.vtkScalarBarActor()
        bar.SetLookupTable(table)
        bar.SetOrientationToHorizontal()
        bar.SetNumberOfLabels(n_labels)
        bar.SetMaximumNumberOfColors(256)
        bar.SetLabelFormat("%.3g")
        bar.UnconstrainedFontSizeOn()
        bar.SetTextPositionToPrecedeScalarBar()
        style(bar.GetLabelTextProperty(), 26)
        bar.GetPositionCoordinate().SetValue(0.2, 0.36)
        bar.SetWidth(0.6)
        bar.SetHeight(0.5)
        bar.SetBarRatio(0.45)
        bar.SetTextPad(6)
        renderer.AddViewProp(bar)
        renderer.AddViewProp(text_actor(label, 28, 0.5, 0.06, "centre"))

    def save(self, name):
        self.window.Render()
        image = vtk.vtkWindowToImageFilter()
        image.SetInput(self.window)
        image.ReadFrontBufferOff()
        image.Update()
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(name)
        writer.SetInputConnection(image.GetOutputPort())
        writer.Write()
        if not os.path.exists(name):
            raise Missing(f"{name} could not be written")


# The academic case


def lengths(folder):
    """Lengths [mm] of the geometry from the run's resolved parameters."""
    name = os.path.join(folder, "parameters.prm")
    default = {"Root half width": 3.5, "Root depth": 16.0, "Bone width": 49.0,
               "Bone height": 40.0, "Centre margin": 10.0}
    if os.path.exists(name):
        with open(name, encoding="utf-8") as file:
            text = file.read()
        for key in default:
            found = re.search(rf"set {key}\s*=\s*([-+.\deE]+)", text)
            if found:
                default[key] = float(found.group(1))
    return default


def named_points(size):
    """Points A to L of the paper's Figure 1, in the initial mesh."""
    c = size["Root half width"]
    x = [-c - size["Bone width"], -c - size["Centre margin"], -c]
    x += [-v for v in reversed(x)]
    points = {}
    for i in range(6):
        points["ABCDEF"[i]] = (x[i], 0.0)
        points["GHIJKL"[i]] = (x[i], -size["Bone height"])
    return points


def mark_regions(grid, points):
    """A cell field: 0 left, 1 centre, 2 right block."""
    array = vtk.vtkDoubleArray()
    array.SetName("block")
    for c in range(grid.GetNumberOfCells()):
        box = grid.GetCell(c).GetBounds()
        x = (box[0] + box[1]) / 2
        array.InsertNextValue(
            0 if x < points["B"][0] else 2 if x > points["E"][0] else 1)
    grid.GetCellData().AddArray(array)


def label_actors(points):
    """Dots and letters, those of the bottom line below it."""
    actors = []
    for name, (x, y) in points.items():
        sphere = vtk.vtkDiskSource()
        sphere.SetInnerRadius(0)
        sphere.SetOuterRadius(0.45)
        sphere.SetCircumferentialResolution(24)
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(sphere.GetOutputPort())
        dot = vtk.vtkActor()
        dot.SetMapper(mapper)
        dot.SetPosition(x, y, 1)
        dot.GetProperty().SetColor(0.7, 0.0, 0.0)
        dot.GetProperty().LightingOff()
        letter = vtk.vtkBillboardTextActor3D()
        letter.SetInput(name)
        style(letter.GetTextProperty(), 34)
        letter.GetTextProperty().SetJustificationToCentered()
        letter.GetTextProperty().SetVerticalJustificationToCentered()
        letter.SetPosition(x, y + (2.6 if name < "G" else -2.6), 2)
        actors += [dot, letter]
    return actors


def region_names(points):
    actors = []
    y = 0.55 * points["G"][1]
    for text, x in (("left", (points["A"][0] + points["B"][0]) / 2),
                    ("right", (points["E"][0] + points["F"][0]) / 2),
                    ("centre", 0.0)):
        actor = vtk.vtkBillboardTextActor3D()
        actor.SetInput(text)
        style(actor.GetTextProperty(), 34)
        actor.GetTextProperty().SetBackgroundColor(1, 1, 1)
        actor.GetTextProperty().SetBackgroundOpacity(0.8)
        actor.GetTextProperty().SetJustificationToCentered()
        actor.SetPosition(x, y if text != "centre" else 0.85 * points["G"][1],
                          2)
        actors.append(actor)
    return actors


def figure_1(root):
    folder = os.path.join(root, "academic")
    grid = read(states(folder)[0][1])
    points = named_points(lengths(folder))
    mark_regions(grid, points)
    b = bounds([grid])
    picture = Picture([(b[0] - 3, b[1] + 3, b[2] - 4.5, b[3] + 4.5)], bar=False)
    picture.panel(
        f"Initial mesh: {grid.GetNumberOfCells()} quadrangles, named points "
        "and regions",
        mesh_actors(grid, "block", colours(REGIONS, (0, 2)))
        + label_actors(points) + region_names(points))
    picture.save(os.path.join(root, "figures", "academic-1-mesh.png"))


def around_root(size, moved):
    """The window shown around a root that has moved so far [mm]."""
    half = size["Root half width"]
    return (moved - 5.5 * half, moved + 5.5 * half, -1.4 * size["Root depth"],
            1.0)


def figure_4(root):
    ale = states(os.path.join(root, "academic"))
    lagrangian = states(os.path.join(root, "academic-lagrangian"))
    size = lengths(os.path.join(root, "academic"))
    chosen = [("ALE mesh", nearest(ale, 180)),
              ("Lagrangian mesh", nearest(lagrangian, 180))]
    last = lagrangian[-1][0]
    grids = [read(state[1]) for _, state in chosen]
    windows = [around_root(size, 10.5 * state[0] / 365) for _, state in chosen]
    table = colours(DIVERGING, symmetric_range(grids, "stimulus", windows[0]))
    picture = Picture(windows)
    for (mesh, state), grid in zip(chosen, grids):
        ends = mesh.startswith("Lag") and state[0] == last and last < 180
        picture.panel(
            f"{mesh}, {state[0]:.4g} T" + (", where it stops" if ends else ""),
            mesh_actors(grid, "stimulus", table))
    picture.colour_bar(table, LABELS["stimulus"])
    picture.save(os.path.join(root, "figures", "academic-4-criterion.png"))


def series(root, name, times, field, table_of, title):
    """One run at several times, whole mesh, below each other."""
    all_states = states(os.path.join(root, "academic"))
    # Each state once, also if the run stopped early
    chosen = sorted({nearest(all_states, time) for time in times})
    grids = [read(state[1]) for state in chosen]
    b = bounds(grids)
    window = (b[0] - 1, b[1] + 1, b[2] - 0.5, b[3] + 0.5)
    table = table_of(grids, window)
    picture = Picture([window] * len(grids))
    for state, grid in zip(chosen, grids):
        picture.panel(f"{title}{state[0]:.4g} T",
                      mesh_actors(grid, field, table))
    picture.colour_bar(table, LABELS[field])
    picture.save(os.path.join(root, "figures", name))


def academic(root):
    figure_1(root)
    figure_4(root)
    series(root, "academic-6-series.png", (36.5, 180, 365), "stimulus",
           lambda grids, window: colours(
               DIVERGING, symmetric_range(grids, "stimulus", window)),
           "ALE mesh and criterion, ")
    series(root, "academic-7-density.png", (365,), "density",
           lambda grids, window: colours(SEQUENTIAL, limits(grids, "density")),
           "Apparent density, ")


# Any scene


def limits(grids, field):
    values = [v for g in grids for v in finite_values(g, field)]
    if not values:
        raise Missing(f"{field} has no finite value")
    low, high = min(values), max(values)
    if high - low <= 1e-6 * max(abs(low), abs(high)):  # a constant in float
        half = 0.05 * abs(low) or 0.5
        return (low - half, high + half)
    return (low, high)


def scene(root, name):
    """The last state, coloured by the most telling field there is."""
    time, file = states(os.path.join(root, name))[-1]
    grid = read(file)
    for field in ("stimulus", "von_Mises_stress", "scaled_Jacobian", "region"):
        try:
            if finite_values(grid, field):
                break
        except Missing:
            pass
    else:
        raise Missing(f"{file} has none of the fields that are drawn")
    b = grid.GetBounds()
    three_d = b[5] - b[4] > 1e-9
    pad = 0.02 * max(b[1] - b[0], b[3] - b[2])
    window = ((0, 16, 0, 10) if three_d else
              (b[0] - pad, b[1] + pad, b[2] - pad, b[3] + pad))
    signed = field == "stimulus"
    table = colours(DIVERGING if signed else SEQUENTIAL,
                    symmetric_range([grid], field, None) if signed
                    else limits([grid], field))
    picture = Picture([window], three_d=three_d)
    picture.panel(f"{name}, {time:.4g} T", mesh_actors(grid, field, table))
    picture.colour_bar(table, LABELS[field])
    picture.save(os.path.join(root, "figures", f"{name}-mesh.png"))


def main(arguments):
    if len(arguments) != 2:
        print("usage: render.py NAME OUTPUT_ROOT", file=sys.stderr)
        return 2
    name, root = arguments
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_WARNING)
    try:
        os.makedirs(os.path.join(root, "figures"), exist_ok=True)
        if name == "academic":
            academic(root)
        else:
            scene(root, name)
    except (Missing, OSError, xml.etree.ElementTree.ParseError) as error:
        print(f"render.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
