# SPDX-License-Identifier: LGPL-2.1-or-later
"""Picture of the last state of a three-dimensional run.

render_3d.py RUN_FOLDER FIELD PICTURE.png [REGION] draws the deformed mesh of
RUN_FOLDER/fields.pvd coloured by FIELD, seen from the plane of symmetry, if
asked for only the cells of one region number. Needs python3-vtk9 and a display
(xvfb-run).
"""
import sys

import vtk

import render


def main(arguments):
    if len(arguments) not in (3, 4):
        print(__doc__, file=sys.stderr)
        return 2
    folder, field, picture = arguments[:3]
    try:
        _, name = render.states(folder)[-1]
    except render.Missing as error:
        print(f"render_3d.py: {error}", file=sys.stderr)
        return 2
    reader = (vtk.vtkXMLPUnstructuredGridReader() if name.endswith(".pvtu")
              else vtk.vtkXMLUnstructuredGridReader())
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    if data.GetArray(field) is None and grid.GetCellData().GetArray(field) is None:
        print(f"render_3d.py: {name} has no field '{field}'", file=sys.stderr)
        return 2
    if len(arguments) == 4:
        threshold = vtk.vtkThreshold()
        threshold.SetInputData(grid)
        location = 0 if data.GetArray("region") is not None else 1
        threshold.SetInputArrayToProcess(0, 0, 0, location, "region")
        number = float(arguments[3])
        threshold.SetLowerThreshold(number - 0.5)
        threshold.SetUpperThreshold(number + 0.5)
        threshold.Update()
        grid = threshold.GetOutput()
        data = grid.GetPointData()
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    at_points = data.GetArray(field) is not None
    array = data.GetArray(field) if at_points else grid.GetCellData().GetArray(field)
    if at_points:
        mapper.SetScalarModeToUsePointFieldData()
    else:
        mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(field)
    mapper.SetScalarRange(array.GetRange())
    colours = vtk.vtkColorTransferFunction()
    low, high = array.GetRange()
    for part, *rgb in render.SEQUENTIAL:
        colours.AddRGBPoint(low + part * (high - low), *rgb)
    mapper.SetLookupTable(colours)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.2, 0.2, 0.2)
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle(render.LABELS.get(field, field))
    bar.GetTitleTextProperty().SetColor(0, 0, 0)
    bar.GetLabelTextProperty().SetColor(0, 0, 0)
    bar.SetMaximumWidthInPixels(110)
    bar.SetUnconstrainedFontSize(True)
    bar.GetTitleTextProperty().SetFontSize(22)
    bar.GetLabelTextProperty().SetFontSize(22)
    bar.SetPosition(0.84, 0.1)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    renderer.AddViewProp(bar)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(render.WIDTH, 900)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(-0.35, 0.55, -1.0)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 1, 0)
    renderer.ResetCamera()
    camera.Zoom(1.0)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
