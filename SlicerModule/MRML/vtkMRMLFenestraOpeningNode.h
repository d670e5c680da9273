#ifndef __vtkMRMLFenestraOpeningNode_h
#define __vtkMRMLFenestraOpeningNode_h

#include <vtkMRMLNode.h>

#ifndef __VTK_WRAP__
#include "FenestraViewCamera.h"
#include "FenestraViewImage.h"
#include "clip/portable/LiveSurface.h"

#include <memory>
#endif

#include <string>

#include "vtkSlicerFenestraModuleMRMLExport.h"

class vtkMRMLFenestraRenderNode;

/// \brief The opened view: the volume rendering in the 3D views, cut by the clipping surface of a
/// focus, and the path-traced image of one 3D view, shown while its camera rests.
///
/// Volume, segmentation, focus and clipping are those of the settings (reference `settings`). Saved
/// with the scene, but for the triangles of the focus, which are made again.
class VTK_SLICER_FENESTRA_MODULE_MRML_EXPORT vtkMRMLFenestraOpeningNode : public vtkMRMLNode {
public:
  static vtkMRMLFenestraOpeningNode* New();
  vtkTypeMacro(vtkMRMLFenestraOpeningNode, vtkMRMLNode);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMRMLNode* CreateNodeInstance() override;
  const char* GetNodeTagName() override { return "FenestraOpening"; }
  void ReadXMLAttributes(const char** atts) override;
  void WriteXML(ostream& of, int indent) override;
  vtkMRMLCopyContentMacro(vtkMRMLFenestraOpeningNode);

  /// True: the 3D views are opened.
  vtkGetMacro(Visible, bool);
  vtkSetMacro(Visible, bool);
  vtkBooleanMacro(Visible, bool);

  /// True: one 3D view shows a path-traced image while its camera rests.
  vtkGetMacro(Photorealistic, bool);
  vtkSetMacro(Photorealistic, bool);
  vtkBooleanMacro(Photorealistic, bool);
  /// True while there is an image. Not saved.
  bool HasImage() const;

  /// Null: none.
  vtkMRMLFenestraRenderNode* GetSettings();
  static constexpr const char* SettingsRole = "settings";

  /// Why nothing is cut although the node is visible, as a sentence; empty: it is, or will be once
  /// the triangles are there. Not saved.
  const std::string& GetProblem() const { return this->Problem; }
  void SetProblem(const std::string& problem);
  /// True once the triangles of the focus are there.
  bool HasFocus() const;
  /// True while newer triangles are made. Not saved.
  vtkGetMacro(Preparing, bool);
  vtkSetMacro(Preparing, bool);

#ifndef __VTK_WRAP__
  /// The surface of the focus and the corners of the volume's box, RAS mm.
  using Focus = std::shared_ptr<const fenestra::core::ClosedSurface>;
  void SetFocus(const Focus& focus, const fenestra::core::BoxCorners& volume);
  const Focus& GetFocus() const {
    return this->Triangles;
  }
  const fenestra::core::BoxCorners& GetVolumeCorners() const {
    return this->VolumeCorners;
  }
  /// The image of a 3D view, with the camera that it shows.
  struct ViewImage {
    std::shared_ptr<const FenestraViewImage> image; ///< null: none
    FenestraViewCamera camera = {};
    std::string viewID = {}; ///< of the 3D view's node
  };
  void SetImage(const ViewImage& image);
  const ViewImage& GetImage() const {
    return this->Image;
  }
#endif

protected:
  vtkMRMLFenestraOpeningNode();
  ~vtkMRMLFenestraOpeningNode() override;
  vtkMRMLFenestraOpeningNode(const vtkMRMLFenestraOpeningNode&) = delete;
  void operator=(const vtkMRMLFenestraOpeningNode&) = delete;

  bool Visible = false;
  bool Photorealistic = false;
  bool Preparing = false;
  std::string Problem;
#ifndef __VTK_WRAP__
  Focus Triangles;
  fenestra::core::BoxCorners VolumeCorners = {};
  ViewImage Image;
#endif
};

#endif
