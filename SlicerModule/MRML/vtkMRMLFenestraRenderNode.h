#ifndef __vtkMRMLFenestraRenderNode_h
#define __vtkMRMLFenestraRenderNode_h

#include <vtkMRMLNode.h>

#include <map>
#include <string>
#include <vector>

#include "vtkSlicerFenestraModuleMRMLExport.h"

class vtkMRMLModelNode;
class vtkMRMLVolumeNode;

/// \brief Settings and results of a rendered image.
///
/// Settings are flags: options of the renderer's command line with their values. They are saved as
/// attributes of the same names, so that `fenestra scene.mrml` reproduces the image. If a scene has
/// several such nodes, the renderer uses the last.
///
/// Scenes may come from untrusted sources, so attributes are checked when read. Invalid values and
/// file names are withheld: kept and saved again, but not used. Unknown attributes, which a newer
/// version wrote, are kept and saved again, too.
///
/// References: `volume`, `segmentation`, `view` (its camera is followed unless a flag sets the
/// view), `plane` (source of the flag `plane`), and results: `picture` (display colors; for a
/// turntable all frames, one per slice), `radiance` (linear RGBA), `depth` (mm) and `surface` (the
/// clipping surface, a model).
class VTK_SLICER_FENESTRA_MODULE_MRML_EXPORT vtkMRMLFenestraRenderNode : public vtkMRMLNode {
public:
  static vtkMRMLFenestraRenderNode* New();
  vtkTypeMacro(vtkMRMLFenestraRenderNode, vtkMRMLNode);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMRMLNode* CreateNodeInstance() override;
  const char* GetNodeTagName() override { return "FenestraRender"; }
  void ReadXMLAttributes(const char** atts) override;
  void WriteXML(ostream& of, int indent) override;
  vtkMRMLCopyContentMacro(vtkMRMLFenestraRenderNode);

  /// Names of the flags that a node can hold; others are ignored.
  static const std::vector<std::string>& GetFlagNames();
  /// Names of the flags that only `fenestra turntable` accepts; the renderer ignores them in
  /// scenes.
  static const std::vector<std::string>& GetTurntableFlagNames();
  /// True if the result is a turntable; false for the settings node, which also has turntable
  /// flags.
  bool IsTurntable() { return !this->GetSingletonTag() && !this->GetFlag("frames").empty(); }

  /// Sets a value as on the command line; empty: removes it. Returns false and logs an error for an
  /// unknown name or a wrong value, without a change.
  bool SetFlag(const std::string& name, const std::string& value);
  std::string GetFlag(const std::string& name) const;
  /// Names of the flags that are set.
  std::vector<std::string> GetActiveFlagNames() const;

  /// Names of the flags of a scene that are withheld; setting a flag removes its withheld value.
  std::vector<std::string> GetWithheldFlagNames() const;
  /// True if a withheld value names a file.
  bool WithholdsFiles() const;
  /// Accepts withheld file names as flags, after the user has allowed them.
  void AllowFiles();
  /// Copies flags, withheld values and unknown attributes from another node; null: no change.
  void CopyFlags(vtkMRMLFenestraRenderNode* node);

  /// Events of a background render, for observers of its node.
  enum { RenderProgressEvent = 62170, RenderEndEvent };
  /// Finished fraction of the render, 0 to 1. Not saved.
  vtkGetMacro(Progress, double);
  /// Sets the fraction and invokes RenderProgressEvent.
  void SetProgress(double fraction);
  /// State of a background render. Not saved.
  enum { NotRequested, Queued, Running, Ended };
  vtkGetMacro(RenderState, int);
  /// Sets Queued or Running; EndRender sets Ended.
  void SetRenderState(int state) { this->RenderState = state; }
  bool IsRendering() const { return this->RenderState == Queued || this->RenderState == Running; }
  /// Why the render ended without an image, as a sentence; empty: it has one, or has not ended.
  const std::string& GetProblem() const { return this->Problem; }
  /// Ends the render and invokes RenderEndEvent; `problem` is empty after success.
  void EndRender(const std::string& problem);

  /// Focus segments by id, name or label value: the flag `focus`, split at its commas. A single
  /// text is one segment, since a list of its letters never is meant; null or empty: no focus.
  void SetFocus(const std::vector<std::string>& segments);
  void SetFocus(const char* segment);
  std::vector<std::string> GetFocus() const;

  /// Volume and segmentation that are rendered; null: none.
  void SetVolumeNode(vtkMRMLNode* volume) { this->SetInput(VolumeRole, volume); }
  vtkMRMLNode* GetVolumeNode() { return this->GetNodeReference(VolumeRole); }
  void SetSegmentationNode(vtkMRMLNode* segmentation) {
    this->SetInput(SegmentationRole, segmentation);
  }
  vtkMRMLNode* GetSegmentationNode() { return this->GetNodeReference(SegmentationRole); }
  /// The image, a vector volume; null: none.
  vtkMRMLNode* GetPictureNode() { return this->GetNodeReference(PictureRole); }

  /// Roles for SetNodeReferenceID and GetNodeReference, for scripts, which cannot read constants.
  static const char* GetVolumeNodeReferenceRole() { return VolumeRole; }
  static const char* GetSegmentationNodeReferenceRole() { return SegmentationRole; }
  static const char* GetViewNodeReferenceRole() { return ViewRole; }
  static const char* GetPlaneNodeReferenceRole() { return PlaneRole; }
  static const char* GetPictureNodeReferenceRole() { return PictureRole; }
  static const char* GetRadianceNodeReferenceRole() { return RadianceRole; }
  static const char* GetDepthNodeReferenceRole() { return DepthRole; }
  static const char* GetSurfaceNodeReferenceRole() { return SurfaceRole; }

  static constexpr const char* VolumeRole = "volume";
  static constexpr const char* SegmentationRole = "segmentation";
  static constexpr const char* ViewRole = "view";
  static constexpr const char* PlaneRole = "plane";
  static constexpr const char* PictureRole = "picture";
  static constexpr const char* RadianceRole = "radiance";
  static constexpr const char* DepthRole = "depth";
  static constexpr const char* SurfaceRole = "surface";

  /// Attribute of a result: measures selected from the renderer's statistics, a JSON object.
  static constexpr const char* MeasuresAttribute = "Fenestra.Measures";
  /// Attribute of a result's depth: its camera, as options of the renderer.
  static constexpr const char* CameraAttribute = "Fenestra.Camera";
  /// Attribute of settings: light rig with strengths in percent, "rig key fill rim environment".
  /// Used only if it produces the flag `lights`.
  static constexpr const char* LightsAttribute = "Fenestra.Lights";
  /// Attribute of settings whose size follows the 3D view: factor and size, "2 1024x768". Used only
  /// if the size is the flag `size`.
  static constexpr const char* ViewSizeAttribute = "Fenestra.ViewSize";

#ifndef __VTK_WRAP__ // Python has no std::map
  /// Replaces all flags. Leaves out unknown names and wrong values.
  void SetFlags(const std::map<std::string, std::string>& flags);
  const std::map<std::string, std::string>& GetFlags() const;
  const std::map<std::string, std::string>& GetWithheld() const; ///< flags that are withheld
#endif

protected:
  vtkMRMLFenestraRenderNode();
  ~vtkMRMLFenestraRenderNode() override;
  vtkMRMLFenestraRenderNode(const vtkMRMLFenestraRenderNode&) = delete;
  void operator=(const vtkMRMLFenestraRenderNode&) = delete;

  void SetInput(const char* role, vtkMRMLNode* node) {
    this->SetNodeReferenceID(role, node ? node->GetID() : nullptr);
  }
  using Values = std::map<std::string, std::string>;
  void Assign(Values flags, Values withheld, Values unknown);

  double Progress = 0.0;
  int RenderState = NotRequested;
  std::string Problem;
  Values Flags, Withheld;
  Values Unknown; ///< attributes of the scene that neither this class nor its base knows
};

#endif
