#!/usr/bin/env python3
"""Renders a .nii.gz volume by VTK's GPU ray casting (vtkGPUVolumeRayCastMapper), as 3D Slicer does.

usage: render_vtk.py VOLUME PRESETS NAME OUTPUT.png SIZE CAMERA [cut]
PRESETS is Slicer's presets.xml, NAME a volume property in it, SIZE the edge of the image in pixels and CAMERA options of
Fenestra: --scale MM --position=R,A,S --target=R,A,S --up=R,A,S (RAS, mm). `cut` removes all in front of the target.
Background and shading are Slicer's, steps half a voxel. Exit status 3 if VTK is not installed.
"""
import re
import sys
import xml.etree.ElementTree

try:
    import vtk
except ImportError:
    sys.exit(3)

volume, presets, name, output, size, camera_options = sys.argv[1:7]
cut = sys.argv[7:] == ["cut"]


def parse_numbers(text):
    return [float(number) for number in text.replace(",", " ").split()]


def read_volume(path):
    """Returns the image with its scalars, and the transform from its coordinates to RAS."""
    reader = vtk.vtkNIFTIImageReader()
    reader.SetFileName(path)
    reader.Update()
    rescale = vtk.vtkImageShiftScale()
    rescale.SetInputConnection(reader.GetOutputPort())
    slope = reader.GetRescaleSlope() or 1
    rescale.SetScale(slope)
    rescale.SetShift(reader.GetRescaleIntercept() / slope)
    rescale.SetOutputScalarTypeToShort()
    rescale.Update()
    return rescale.GetOutput(), reader.GetSFormMatrix() or reader.GetQFormMatrix()


def read_property(path, preset):
    """Returns the volume property of this name; its functions list a count, then the points."""
    for node in xml.etree.ElementTree.parse(path).getroot().iter("VolumeProperty"):
        if node.get("name") == preset:
            break
    else:
        sys.exit(f"{path}: has no volume property {preset}")
    color = vtk.vtkColorTransferFunction()
    points = parse_numbers(node.get("colorTransfer"))[1:]
    for i in range(0, len(points), 4):
        color.AddRGBPoint(*points[i:i + 4])
    opacities = []
    for attribute in "scalarOpacity", "gradientOpacity":
        opacity = vtk.vtkPiecewiseFunction()
        points = parse_numbers(node.get(attribute))[1:]
        for i in range(0, len(points), 2):
            opacity.AddPoint(*points[i:i + 2])
        opacities.append(opacity)
    result = vtk.vtkVolumeProperty()
    result.SetColor(color)
    result.SetScalarOpacity(opacities[0])
    result.SetGradientOpacity(opacities[1])
    result.SetInterpolationTypeToLinear()
    result.SetShade(int(node.get("shade", "1")))
    result.SetAmbient(float(node.get("ambient")))
    result.SetDiffuse(float(node.get("diffuse")))
    result.SetSpecular(float(node.get("specular")))
    result.SetSpecularPower(float(node.get("specularPower")))
    return result


view = {key: parse_numbers(value) for key, value in
        re.findall(r"--(scale|position|target|up)[ =]([-+.,0-9e]+)", camera_options)}
image, to_ras = read_volume(volume)

mapper = vtk.vtkGPUVolumeRayCastMapper()
mapper.SetInputData(image)
mapper.SetUseJittering(1)
mapper.SetAutoAdjustSampleDistances(0)
mapper.SetSampleDistance(min(image.GetSpacing()) / 2)
if cut:
    plane = vtk.vtkPlane()
    plane.SetOrigin(view["target"])
    plane.SetNormal([t - p for t, p in zip(view["target"], view["position"])])
    mapper.AddClippingPlane(plane)
actor = vtk.vtkVolume()
actor.SetMapper(mapper)
actor.SetProperty(read_property(presets, name))
actor.SetUserMatrix(to_ras)

renderer = vtk.vtkRenderer()
renderer.AddVolume(actor)
renderer.GradientBackgroundOn()
renderer.SetBackground(0.7568627, 0.7647059, 0.9098039)
renderer.SetBackground2(0.4549020, 0.4705882, 0.7450980)
camera = renderer.GetActiveCamera()
camera.SetPosition(view["position"])
camera.SetFocalPoint(view["target"])
camera.SetViewUp(view["up"])
camera.ParallelProjectionOn()
camera.SetParallelScale(view["scale"][0])
renderer.ResetCameraClippingRange()

window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(int(size), int(size))
window.AddRenderer(renderer)
window.Render()
grab = vtk.vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtk.vtkPNGWriter()
writer.SetFileName(output)
writer.SetInputConnection(grab.GetOutputPort())
writer.Write()
