"""Draws the points of a PLY file as square points with VTK, off screen, and reads every frame back."""

import argparse

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def morton_order(points):
    """Indices that sort points along a Morton curve of 21 bits an axis."""
    low, high = points.min(axis=0), points.max(axis=0)
    cells = ((points - low) / max((high - low).max(), 1e-30) * (2**21 - 1)).astype(numpy.uint64)
    codes = numpy.zeros(len(points), numpy.uint64)
    for bit in range(21):
        for axis in range(3):
            codes |= (cells[:, axis] >> numpy.uint64(bit) & numpy.uint64(1)) << numpy.uint64(3 * bit + axis)
    return numpy.argsort(codes, kind="stable")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--order", choices=["shuffled", "sorted"], required=True)
    parser.add_argument("--width", type=float, required=True, help="of a point, px")
    parser.add_argument("--size", type=int, default=1024, help="of the picture, px")
    parser.add_argument("--frames", type=int, required=True)
    parser.add_argument("--eye", type=lambda text: [float(part) for part in text.split(",")])
    parser.add_argument("--picture", help="PNG of the last frame")
    arguments = parser.parse_args()

    reader = vtk.vtkPLYReader()
    reader.SetFileName(arguments.file)
    reader.Update()
    read = reader.GetOutput()
    points = vtk_to_numpy(read.GetPoints().GetData())
    if arguments.order == "sorted":
        order = morton_order(points.astype(numpy.float64))
    else:
        order = numpy.random.default_rng(1).permutation(len(points))

    cloud = vtk.vtkPolyData()
    cloud.SetPoints(vtk.vtkPoints())
    cloud.GetPoints().SetData(numpy_to_vtk(points[order], deep=True))
    colours = read.GetPointData().GetScalars()
    if colours is not None:
        cloud.GetPointData().SetScalars(numpy_to_vtk(vtk_to_numpy(colours)[order], deep=True))
    vertices = vtk.vtkVertexGlyphFilter()
    vertices.SetInputData(cloud)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(vertices.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetPointSize(arguments.width)
    actor.GetProperty().LightingOff()

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.SetViewAngle(45)
    if arguments.eye:
        camera.SetPosition(arguments.eye)
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewUp(0, 1, 0)
        renderer.ResetCameraClippingRange()
    else:
        renderer.ResetCamera()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(arguments.size, arguments.size)
    window.AddRenderer(renderer)

    pixels = vtk.vtkUnsignedCharArray()
    last = arguments.size - 1
    for _ in range(arguments.frames):
        window.Render()
        window.GetRGBACharPixelData(0, 0, last, last, 0, pixels)

    if arguments.picture:
        image = vtk.vtkWindowToImageFilter()
        image.SetInput(window)
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(arguments.picture)
        writer.SetInputConnection(image.GetOutputPort())
        writer.Write()


if __name__ == "__main__":
    main()
