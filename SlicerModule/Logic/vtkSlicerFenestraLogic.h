#ifndef __vtkSlicerFenestraLogic_h
#define __vtkSlicerFenestraLogic_h

#include <vtkSlicerModuleLogic.h>

#include <vtkSmartPointer.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "FenestraSceneFiles.h"
#include "vtkSlicerFenestraModuleLogicExport.h"

class vtkImageData;
class vtkMRMLCameraNode;
class vtkMRMLFenestraRenderNode;
class vtkMRMLNode;
class vtkMRMLScalarVolumeNode;
class vtkMRMLSegmentationNode;
class vtkMRMLSliceLogic;
class vtkMRMLVolumeNode;
class vtkPolyData;

/// Result of a render, read from its files. VTK's wrapper for Python takes structs whose names
/// begin with `vtk` for classes of its own kind: no other name does here. A turntable has only
/// `picture`, with one frame a slice.
struct FenestraResult {
  SlicerExport::Image radiance;          ///< linear RGBA, placed in the world
  SlicerExport::Image depth;             ///< mm from the eye; infinite: nothing seen
  vtkSmartPointer<vtkImageData> picture; ///< display colours, row 0 at the top
  vtkSmartPointer<vtkPolyData> surface;  ///< clipping surface, RAS; null: none
};

/// Renders in the background. The module has one: processes are Qt's, which the logic does not
/// know.
class FenestraRenderer {
public:
  virtual ~FenestraRenderer() = default;
  /// Adds a node for a render of the settings and queues it; null: the log says why not.
  virtual vtkMRMLFenestraRenderNode* start(vtkMRMLFenestraRenderNode* settings, bool turntable) = 0;
  virtual bool isActive(vtkMRMLFenestraRenderNode* render) const = 0;
  /// Returns when the render has ended; events are processed meanwhile, user input is not.
  virtual void waitFor(vtkMRMLFenestraRenderNode* render) = 0;
  /// Ends the render under way, keeping what is finished.
  virtual void stop() = 0;
};

/// \brief Exchange between Slicer's scene and the renderer's files.
///
/// All calls are quick: files are written and read in other threads (SlicerExport::Writer,
/// ReadResult).
class VTK_SLICER_FENESTRA_MODULE_LOGIC_EXPORT vtkSlicerFenestraLogic : public vtkSlicerModuleLogic {
public:
  static vtkSlicerFenestraLogic* New();
  vtkTypeMacro(vtkSlicerFenestraLogic, vtkSlicerModuleLogic);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Settings that the panel edits; created if missing. A singleton of the scene; renders are
  /// copies.
  vtkMRMLFenestraRenderNode* GetSettings();
  /// Adds a node for a render with the current settings; a followed camera becomes a fixed view. A
  /// turntable's node keeps the flags of turntables.
  vtkMRMLFenestraRenderNode* AddRender(vtkMRMLFenestraRenderNode* settings, bool turntable = false);

  /// Renders the settings in the background and returns the render's node, which tells of progress
  /// and end (RenderProgressEvent, RenderEndEvent). Null: the log says why. `wait`: returns at the
  /// end; a render without a picture, of which the log says why, is null.
  vtkMRMLFenestraRenderNode* Render(vtkMRMLFenestraRenderNode* settings, bool wait = false);
  vtkMRMLFenestraRenderNode* RenderTurntable(vtkMRMLFenestraRenderNode* settings,
                                             bool wait = false);
  /// Ends the render under way, keeping what is finished.
  void StopRender();
  bool IsRendering(vtkMRMLFenestraRenderNode* render);
  /// Called when a renderer is needed first.
  void SetRenderer(std::function<FenestraRenderer*()> renderer);

  /// Writes the scene that the renderer would be given into a folder, and returns its path; empty:
  /// the log says why.
  std::string WriteScene(vtkMRMLFenestraRenderNode* render, const std::string& folder);
  /// Sets the view to that of a camera, as flags.
  void UseCamera(vtkMRMLFenestraRenderNode* render, vtkMRMLCameraNode* camera);

  /// All that the renderer needs except the flags, without a copy of the voxels. `folder`: private,
  /// for data that Slicer can only write as files. Throws SlicerExport::Complaint.
  SlicerExport::Contents Snapshot(vtkMRMLFenestraRenderNode* render,
                                  const std::filesystem::path& folder);
  /// Names, tags and colours of the segments that the node names; of none without a segmentation.
  static std::vector<SlicerExport::Segment> GetSegments(vtkMRMLFenestraRenderNode* render);
  /// The node's flags, and those of its 3-D view's camera unless another flag sets the view.
  std::map<std::string, std::string> GetFlags(vtkMRMLFenestraRenderNode* render);
  static std::map<std::string, std::string> GetCameraFlags(vtkMRMLCameraNode* camera);
  /// Flag value of a plane of the Markups module; empty: no plane, or not placed yet.
  static std::string GetPlaneFlag(vtkMRMLNode* plane);
  /// Camera of the node's 3-D view; null: the flags set the view.
  vtkMRMLCameraNode* GetFollowedCamera(vtkMRMLFenestraRenderNode* render);

  /// Reads a result from `folder`, where files have the names of GetArguments. Throws
  /// SlicerExport::FileError. Thread-safe.
  static FenestraResult ReadResult(const std::string& folder);
  /// Command line flags for rendering the node, with outputs that ReadResult reads.
  static std::vector<std::string> GetArguments(vtkMRMLFenestraRenderNode* render, bool withSurface);
  /// Finished frames of a turntable in `folder`, from frame 0 to the first missing one.
  static std::vector<std::string> GetFrameFiles(const std::string& folder);
  /// True if a render with these flags has a clipping surface.
  static bool HasSurface(const std::map<std::string, std::string>& flags);

  /// Adds nodes of the result, referenced by the render: one a step, so that the application stays
  /// responsive between steps, 0 to ResultSteps - 1. For a resumed turntable, replaces the frames.
  void AddResult(vtkMRMLFenestraRenderNode* render, const FenestraResult& result, int step);
  static constexpr int ResultSteps = 4;
  /// Shows the scene's newest volume in the slice views; loading a scene does not change them.
  void ShowNewestVolume();
  /// Shows the render's picture beside a 3-D view, in the module's own layout.
  void ShowResult(vtkMRMLFenestraRenderNode* render);
  /// Shows the layout that the module's own took the place of.
  void ShowLayoutBefore();
  /// Render whose picture the module's layout shows; null: none.
  vtkMRMLFenestraRenderNode* GetShownRender();
  /// Shows another frame of a turntable, in the same view.
  void ShowFrame(vtkMRMLFenestraRenderNode* render, int frame);
  /// Frames in the render's picture; 1: not a turntable; 0: no picture.
  static int GetNumberOfFrames(vtkMRMLFenestraRenderNode* render);

protected:
  vtkSlicerFenestraLogic();
  ~vtkSlicerFenestraLogic() override;
  vtkSlicerFenestraLogic(const vtkSlicerFenestraLogic&) = delete;
  void operator=(const vtkSlicerFenestraLogic&) = delete;

  void RegisterNodes() override;
  void SetMRMLSceneInternal(vtkMRMLScene* scene) override;
  /// Registers the module's layout, in which the scene may have been saved.
  void OnMRMLSceneStartImport() override;
  void OnMRMLSceneNodeRemoved(vtkMRMLNode* node) override;

private:
  vtkMRMLFenestraRenderNode* Start(vtkMRMLFenestraRenderNode* settings, bool turntable, bool wait);
  vtkMRMLSliceLogic* GetPictureView();
  SlicerExport::Matrix MoveOutsideVolume(vtkMRMLFenestraRenderNode* render,
                                         const SlicerExport::Matrix& ijkToRas);
  void MoveToRenderFolder(vtkMRMLFenestraRenderNode* render, vtkMRMLNode* result);
  void AddSurface(vtkMRMLFenestraRenderNode* render, vtkPolyData* surface);
  void AddFrames(vtkMRMLFenestraRenderNode* render, vtkImageData* frames);
  vtkMRMLVolumeNode* AddVolume(vtkMRMLFenestraRenderNode* render, const char* className,
                               const char* role, vtkImageData* image,
                               const SlicerExport::Matrix& ijkToRas);

  std::function<FenestraRenderer*()> Renderer;
  int PreviousLayout = 3; ///< vtkMRMLLayoutNode::SlicerLayoutFourUpView
};

#endif
