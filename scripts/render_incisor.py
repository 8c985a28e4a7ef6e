# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the incisor: the whole mesh, and both alveolar margins at several
loads with the worst elements in red.

render_incisor.py OUTPUT_ROOT reads OUTPUT_ROOT/incisor, incisor-lagrangian and
incisor-ale, and writes into OUTPUT_ROOT/figures. Needs python3-vtk9 and a display (xvfb-run).
"""
import os
import sys
import xml.etree.ElementTree

try:
    import vtk
except ImportError:
    sys.exit("render_incisor.py: no VTK; run scripts/install-dependencies figures")

COLOURS = [(0.78, 0.86, 0.94), (0.99, 0.92, 0.76), (0.80, 0.92, 0.77)]
MARGINS = [("stretched (labial) margin", -2.62, 10.62),
           ("compressed (lingual) margin", 2.78, 10.72)]
LOADS = [0.4, 0.65, 0.9, 1.2]
WORST = 0.3  # scaled Jacobian below which an element is red


def series(folder):
    """Times and file names of the fields, the last one of equal times."""
    tree = xml.etree.ElementTree.parse(os.path.join(folder, "fields.pvd"))
    files = {}
    for entry in tree.iter("DataSet"):
        files[float(entry.get("timestep"))] = entry.get("file")
    return files


def actor(file_name):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(file_name)
    reader.Update()
    grid = reader.GetOutput()
    region = grid.GetPointData().GetArray("region")
    quality = grid.GetPointData().GetArray("scaled_Jacobian")
    colour = vtk.vtkUnsignedCharArray()
    colour.SetNumberOfComponents(3)
    for i in range(grid.GetNumberOfPoints()):
        rgb = COLOURS[int(region.GetTuple1(i))]
        if quality.GetTuple1(i) < WORST:
            rgb = (0.84, 0.19, 0.15)
        colour.InsertNextTuple3(*[int(255 * c) for c in rgb])
    grid.GetPointData().SetScalars(colour)
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputData(grid)
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().EdgeVisibilityOn()
    result.GetProperty().SetAmbient(1.0)
    result.GetProperty().SetDiffuse(0.0)
    return result


def view(file_name, x, y, half_height, title):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor(file_name))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(x, y, 0)
    camera.SetPosition(x, y, 10)
    camera.SetParallelScale(half_height)
    text = vtk.vtkTextActor()
    text.SetInput(title)
    text.GetTextProperty().SetColor(0, 0, 0)
    text.GetTextProperty().SetFontSize(22)
    text.SetPosition(12, 8)
    renderer.AddActor2D(text)
    return renderer


def draw(renderers, columns, size, file_name):
    rows = (len(renderers) + columns - 1) // columns
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(columns * size[0], rows * size[1])
    for n, renderer in enumerate(renderers):
        column, row = n % columns, rows - 1 - n // columns
        renderer.SetViewport(column / columns, row / rows,
                             (column + 1) / columns, (row + 1) / rows)
        window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(file_name)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def last_loads(root):
    """Both margins of the runs that stop, where they do."""
    views = []
    for name, title in (("incisor-lagrangian", "Lagrangian"), ("incisor-ale", "ALE")):
        folder = os.path.join(root, name)
        load, file = max(series(folder).items())
        views += [view(os.path.join(folder, file), x, y, 0.36,
                       "%s, %s, %.2f N" % (title, margin, load))
                  for margin, x, y in MARGINS]
    return views


def main(root):
    folder = os.path.join(root, "incisor")
    files = series(folder)
    times = sorted(files)
    path = lambda t: os.path.join(folder, files[t])
    draw(last_loads(root), 4, (560, 560),
         os.path.join(root, "figures", "incisor-7-stopped.png"))
    draw([view(path(times[0]), 0, 3.5, 18.5, "")], 1, (900, 1500),
         os.path.join(root, "figures", "incisor-3-mesh.png"))
    near = lambda load: min(times, key=lambda t: abs(t - load))
    views = [view(path(near(load)), x, y, 0.36, "%s, %.2f N" % (name, near(load)))
             for name, x, y in MARGINS for load in LOADS]
    draw(views, len(LOADS), (560, 560),
         os.path.join(root, "figures", "incisor-8-margins.png"))


if __name__ == "__main__":
    main(sys.argv[1])
