#ifndef __vtkMRMLFenestraRenderNode_h
#define __vtkMRMLFenestraRenderNode_h

#include <vtkMRMLNode.h>

#include <map>
#include <string>
#include <vector>

#include "vtkSlicerFenestraModuleMRMLExport.h"

class vtkMRMLModelNode;
class vtkMRMLVolumeNode;

/// \brief What a picture was made of, and what came of it.
///
/// Settings are flags of the renderer's command line, kept as they are there and written into the
/// scene as attributes of the same names, so that `fenestra scene.mrml` makes the picture again. Of
/// several such nodes the renderer follows the last.
///
/// Anybody may have made a scene. So what a scene's attributes say is checked: what is no value of
/// a flag's, and files that the scene names, are kept and written again, but withheld: no flags.
///
/// References: `volume`, `segmentation`, `view` (whose camera is followed as long as no flag says
/// where to look from), `plane` (which the flag `plane` follows), and results: `picture` (display
/// colours; of a turntable its frames, one behind the other), `radiance` (linear RGBA), `depth`
/// (mm) and `surface` (the clipping surface, a model).
class VTK_SLICER_FENESTRA_MODULE_MRML_EXPORT vtkMRMLFenestraRenderNode : public vtkMRMLNode {
public:
  static vtkMRMLFenestraRenderNode* New();
  vtkTypeMacro(vtkMRMLFenestraRenderNode, vtkMRMLNode);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMRMLNode* CreateNodeInstance() override;
  const char* GetNodeTagName() override { return "FenestraRender"; }
  void ReadXMLAttributes(const char** atts) override;
  void WriteXML(ostream& of, int indent) override;
  void Copy(vtkMRMLNode* node) override;

  /// Flags that a node can hold; others are neither set nor read.
  static const std::vector<std::string>& GetFlagNames();
  /// Those of them that are of `fenestra turntable` alone; a scene does not hand them on.
  static const std::vector<std::string>& GetTurntableFlagNames();
  /// Whether the picture is a turntable's frames. (Settings have such flags, too.)
  bool IsTurntable() { return !this->GetSingletonTag() && !this->GetFlag("frames").empty(); }

  /// Values as the command line takes them. An empty one is a flag that is not given.
  void SetFlag(const std::string& name, const std::string& value);
  std::string GetFlag(const std::string& name) const;
  void SetFlags(const std::map<std::string, std::string>& flags);
  const std::map<std::string, std::string>& GetFlags() const { return this->Flags; }

  /// What the node's scene says and is no flag; setting that flag forgets it.
  const std::map<std::string, std::string>& GetWithheld() const { return this->Withheld; }
  /// Whether it names files.
  bool WithholdsFiles() const;
  /// The user allows it: the files are flags from now on.
  void AllowFiles();
  /// Flags, and what is withheld, as another node has them.
  void CopyFlags(vtkMRMLFenestraRenderNode* node);

  /// Ids, names or label values of the focus segments: the flag `focus`, split at its commas.
  void SetFocus(const std::vector<std::string>& segments);
  std::vector<std::string> GetFocus() const;

  static const char* const VolumeRole;
  static const char* const SegmentationRole;
  static const char* const ViewRole;
  static const char* const PlaneRole;
  static const char* const PictureRole;
  static const char* const RadianceRole;
  static const char* const DepthRole;
  static const char* const SurfaceRole;

  /// Of a result: what the renderer measured, as its statistics say it (.json, an object).
  static const char* const MeasuresAttribute;

protected:
  vtkMRMLFenestraRenderNode();
  ~vtkMRMLFenestraRenderNode() override;
  vtkMRMLFenestraRenderNode(const vtkMRMLFenestraRenderNode&) = delete;
  void operator=(const vtkMRMLFenestraRenderNode&) = delete;

  void Assign(std::map<std::string, std::string> flags,
              std::map<std::string, std::string> withheld);

  std::map<std::string, std::string> Flags, Withheld;
};

#endif
