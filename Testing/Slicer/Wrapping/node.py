"""Uses the wrapped node from Python: flags, XML, copies, and invalid arguments such as None.

Arguments: the wrapped headers, whose output of the wrapper is in the current folder.
"""

import pathlib
import re
import sys

import vtkmodules.vtkCommonCore
from FenestraPython import vtkMRMLFenestraOpeningNode as Opening
from FenestraPython import vtkMRMLFenestraPictureDisplayNode as PictureDisplay
from FenestraPython import vtkMRMLFenestraRenderNode as Node
from FenestraPython import vtkMRMLVectorVolumeDisplayNode as VectorDisplay
from vtkmodules.vtkCommonDataModel import vtkImageData


def attempt(call, *arguments):
    """Calls with any arguments: the result may be an exception, but not a crash."""
    try:
        call(*arguments)
    except (TypeError, ValueError):
        pass


node = Node()
node.SetName("render")
node.SetFlag("samples", "64")
messages = []
node.AddObserver("ErrorEvent", lambda *_: messages.append("error"))
assert node.SetFlag("denoise", "off") and node.SetFlag("denoise", "") and not messages
assert not node.SetFlag("nonsense", "1") and len(messages) == 1, "an unknown option is an error"
assert not node.SetFlag("samples", "many") and len(messages) == 2, "so is a wrong value"
node.SetFocus("FemoralCartilage")
assert list(node.GetFocus()) == ["FemoralCartilage"], "a text is not a list of letters"
node.SetFocus("a,b")
assert list(node.GetFocus()) == ["a,b"], "a text is one name"
node.SetFlag("focus", "a\\,b,c")
assert list(node.GetFocus()) == ["a,b", "c"], "as on the command line"
for empty in ("", [], None):
    node.SetFocus(empty)
    assert list(node.GetFocus()) == []
assert list(node.GetActiveFlagNames()) == ["samples"]
node.SetFocus(["liver", "a,b"])
assert node.GetFlag("samples") == "64" and node.GetFlag("nonsense") == ""
assert list(node.GetFocus()) == ["liver", "a,b"]
assert "samples" in node.GetFlagNames()
changes = 'Segment_1: color=#963e2e\\, clip=no,<a\\, "b">: clip=no'
stored = {"materials": "library", "material": changes, "denoise": "off", "noisetarget": "raw"}
for name, value in stored.items():
    node.SetFlag(name, value)
roles = [getattr(Node, f"Get{role}NodeReferenceRole")() for role in
         "Volume Segmentation View Plane Picture Radiance Depth Surface".split()]
assert roles == "volume segmentation view plane picture radiance depth surface".split()
node.SetNodeReferenceID(Node.GetVolumeNodeReferenceRole(), "vtkMRMLScalarVolumeNode1")
assert node.GetNodeReferenceID("volume") == "vtkMRMLScalarVolumeNode1"
node.SetVolumeNode(node)
assert node.GetNodeReferenceID("volume") == node.GetID()
node.SetVolumeNode(None)
assert node.GetNodeReferenceID("volume") == ""

read = Node()
read.ReadAttributes(["name", "other", "clip", "surface", "transfer", "/etc/passwd", "mood", "<deep>"])
assert read.GetFlag("clip") == "surface" and read.GetFlag("transfer") == "", "file names are withheld"
assert read.WithholdsFiles() and list(read.GetWithheldFlagNames()) == ["transfer"]
written = read.ToXml()
assert all(part in written for part in ('clip="surface"', 'transfer="/etc/passwd"', 'mood="&lt;deep>"'))

scene = node.ToXml()
assert 'materials="library"' in scene and "color=#963e2e\\, clip=no" in scene
again = Node()
again.ReadAttributes([text for pair in stored.items() for text in pair])
assert all(one.GetFlag(name) == value for name, value in stored.items() for one in (node, again))

copy = Node()
copy.CopyContent(read)
assert copy.ToXml() == written and copy.HasCopyContent()
copy.AllowFiles()
assert copy.GetFlag("transfer") == "/etc/passwd"

of_vtk = ("IsTypeOf", "IsA", "SafeDownCast", "NewInstance", "GetNumberOfGenerationsFromBase",
          "GetNumberOfGenerationsFromBaseType")  # VTK's own methods, which crash on None
own = [name for name in vars(Node) if name[0].isupper() and name not in of_vtk]
assert {"SetFlag", "SetFocus", "CopyContent"} <= set(own)
for name in own:
    for arguments in ((), (None,), (None, None), ("x",), ("x", None), (node, node), ([],), ([None],)):
        attempt(getattr(node, name), *arguments)
print("node from Python: ok")

# Python has every method of the headers, except those that are excluded on purpose.
for header in map(pathlib.Path, sys.argv[1:]):
    public = header.read_text().split("\nprotected:")[0]
    public = re.sub(r"//.*", "", public)
    public = re.sub(r"#ifndef __VTK_WRAP__.*?#endif|\S[^;]* override\b", "", public, flags=re.DOTALL)
    declared = set(re.findall(r" [A-Z]\w*(?=\()", public)) - {" New"}
    wrapper = pathlib.Path(f"{header.stem}Python.cxx").read_text()
    missing = [name for name in declared if f'{{"{name.strip()}", Py{header.stem}_' not in wrapper]
    assert not missing, f"{header.stem}: not wrapped: {missing}"
    print(f"{header.stem}: {len(declared)} methods are wrapped")

pixels = [(200, 100, 50, 255), (200, 100, 50, 128), (0, 0, 0, 0)]
picture = vtkImageData()
picture.SetDimensions(3, 1, 1)
picture.AllocateScalars(vtkmodules.vtkCommonCore.VTK_UNSIGNED_CHAR, 4)
for x, pixel in enumerate(pixels):
    for component, value in enumerate(pixel):
        picture.SetScalarComponentFromDouble(x, 0, 0, component, value)


def displayed(node):
    image = node.GetDisplayedImage(picture)
    return [tuple(int(image.GetScalarComponentAsDouble(x, 0, 0, component))
                  for component in range(image.GetNumberOfScalarComponents())) for x in range(3)]


assert displayed(PictureDisplay()) == pixels, "color and opacity of the image"
assert len(displayed(VectorDisplay())[0]) == 5, "the stand-in appends an opacity, as Slicer does"
print("opacity of images: ok")

opening = Opening()
assert not opening.GetVisible() and not opening.HasFocus() and opening.GetSettings() is None
opening.VisibleOn()
opening.SetProblem("none")
loaded = Opening()
loaded.ReadAttributes(["visible", "true"])
copied = Opening()
copied.Copy(opening)
assert 'visible="true"' in opening.ToXml() and loaded.GetVisible() and copied.GetVisible()
for argument in (None, 3, opening):
    attempt(opening.SetProblem, argument)
    attempt(opening.Copy, argument)
print("opened view: ok")
