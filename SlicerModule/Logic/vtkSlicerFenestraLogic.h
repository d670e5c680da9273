#ifndef __vtkSlicerFenestraLogic_h
#define __vtkSlicerFenestraLogic_h

#include <vtkSlicerModuleLogic.h>

#include <vtkSmartPointer.h>

#include <map>
#include <string>
#include <vector>

#include "FenestraSceneFiles.h"
#include "vtkSlicerFenestraModuleLogicExport.h"

class vtkImageData;
class vtkMRMLCameraNode;
class vtkMRMLFenestraOpeningNode;
class vtkMRMLFenestraRenderNode;
class vtkMRMLNode;
class vtkMRMLScalarVolumeNode;
class vtkMRMLSegmentationNode;
class vtkMRMLSliceLogic;
class vtkMRMLViewNode;
class vtkMRMLVolumeNode;
class vtkPolyData;

#ifndef __VTK_WRAP__
/// Result of a render, read from its files. A turntable has only `picture`, with one frame per
/// slice.
struct FenestraResult {
  SlicerExport::Image radiance;          ///< linear RGBA, placed in the world
  SlicerExport::Image depth;             ///< mm from the camera; infinite: nothing visible
  vtkSmartPointer<vtkImageData> picture; ///< display colors, row 0 at the top
  vtkSmartPointer<vtkPolyData> surface;  ///< clipping surface, RAS; null: none
};

#endif

/// \brief Converts between Slicer's scene and the renderer's files, and requests renders.
///
/// Calls are quick, except WriteScene and waiting: other threads write and read the files
/// (SlicerExport::Writer, ReadResult). Methods for Python do not throw.
class VTK_SLICER_FENESTRA_MODULE_LOGIC_EXPORT vtkSlicerFenestraLogic : public vtkSlicerModuleLogic {
public:
  static vtkSlicerFenestraLogic* New();
  vtkTypeMacro(vtkSlicerFenestraLogic, vtkSlicerModuleLogic);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Settings that the panel edits; created if missing. A singleton of the scene; renders have
  /// copies.
  vtkMRMLFenestraRenderNode* GetSettings();
  /// Restores the defaults of new settings; keeps volume, segmentation and focus.
  static void ResetSettings(vtkMRMLFenestraRenderNode* settings);
  /// Adds a node for a render with the current settings; a followed camera becomes a fixed view.
  /// Only a turntable's node keeps the turntable flags.
  vtkMRMLFenestraRenderNode* AddRender(vtkMRMLFenestraRenderNode* settings, bool turntable = false);

  /// Requests to the renderer, which observes them: the module's session. The call data of the
  /// first two is the render's node. RenderRequestedEvent: set the node's state, render, and call
  /// its EndRender. RenderWaitEvent: return when the render has ended. ViewChangedEvent: the
  /// view of images has appeared or changed; call AlignView later. OpeningChangedEvent: GetOpening
  /// may return another node. OpeningWaitEvent: return when GetOpening shows what it was asked for,
  /// or cannot. SampleRequestedEvent: load the sample.
  enum {
    RenderRequestedEvent = 62180,
    RenderWaitEvent,
    StopRequestedEvent,
    ViewChangedEvent,
    OpeningChangedEvent,
    OpeningWaitEvent,
    SampleRequestedEvent
  };
  /// Renders the settings in the background and returns the render's node, which reports progress
  /// and end as events (RenderProgressEvent, RenderEndEvent). Null: failed, the log says why.
  /// `wait`: returns after the end; then null also means that there is no image.
  vtkMRMLFenestraRenderNode* Render(vtkMRMLFenestraRenderNode* settings, bool wait = false);
  vtkMRMLFenestraRenderNode* RenderTurntable(vtkMRMLFenestraRenderNode* settings,
                                             bool wait = false);
  /// Stops the current render and keeps finished results.
  void StopRender();
  static bool IsRendering(vtkMRMLFenestraRenderNode* render);

  /// Opens the 3D views: cuts the volume rendering by the clipping surface of the settings' focus,
  /// from now on and for every camera. Shows the volume rendering, created if missing. Null: there
  /// is no volume or no focus, the log says so. `wait`: returns once the views are cut; then null
  /// also means that they cannot be.
  vtkMRMLFenestraOpeningNode* OpenView(vtkMRMLFenestraRenderNode* settings, bool wait = false);
  /// The same after setting the focus to one segment. If it is of another segmentation than before,
  /// or there was no volume, takes the volume on which the segmentation was made; if that is
  /// unknown and there was none, the volume of the slice views.
  vtkMRMLFenestraOpeningNode* OpenSegment(vtkMRMLSegmentationNode* segmentation,
                                          const std::string& segmentId, bool wait = false);
  /// The same with another volume.
  vtkMRMLFenestraOpeningNode* OpenVolume(vtkMRMLScalarVolumeNode* volume);
  void CloseView();
  /// Shows a path-traced image of the settings in their 3D view, or else the first one, while its
  /// camera rests; it is refined until its noise is low. Null: there is no volume, the log says so.
  /// `wait`: returns once the first image is there; then null also means that there is none.
  vtkMRMLFenestraOpeningNode* ShowPhotorealistic(vtkMRMLFenestraRenderNode* settings,
                                                 bool wait = false);
  void HidePhotorealistic();
  /// The scene's opened view, the first if there are several, visible or not; null: none.
  vtkMRMLFenestraOpeningNode* GetOpening();
  /// Why the 3D views cannot be opened with the settings' clip mode, or with the volume rendering's
  /// method, as a sentence; empty: they can.
  static std::string FindOpeningProblem(vtkMRMLFenestraRenderNode* settings);
  /// True if the settings have a volume and a focus.
  static bool CanOpenView(vtkMRMLFenestraRenderNode* settings);

  /// True if the settings have a volume.
  static bool CanShowPhotorealistic(vtkMRMLFenestraRenderNode* settings);

  /// Generates the synthetic sample knee on this computer, adds it to the scene and returns its
  /// volume after some seconds. Null: failed, the log says why.
  vtkMRMLScalarVolumeNode* LoadSample();

  /// Writes the scene as the renderer would receive it into a folder, created if missing, and
  /// returns its path; empty: failed, the log says why.
  std::string WriteScene(vtkMRMLFenestraRenderNode* render, const std::string& folder);
  /// Sets the view to that of a camera, as flags.
  void UseCamera(vtkMRMLFenestraRenderNode* render, vtkMRMLCameraNode* camera);
  /// IDs of the node's segments, for SetFocus; empty without a segmentation.
  static std::vector<std::string> GetSegmentIDs(vtkMRMLFenestraRenderNode* render);
  /// True if the node has a focus, directly or by a preset.
  static bool HasFocus(vtkMRMLFenestraRenderNode* render);
  /// True if a render of the node has a clipping surface.
  static bool HasSurface(vtkMRMLFenestraRenderNode* render);

#ifndef __VTK_WRAP__ // functions that throw, or have types that Python does not know
  /// Collects all inputs of the renderer except the flags, without copying voxels. `folder`:
  /// private, for data that Slicer can only write as files. Throws SlicerExport::UserError.
  SlicerExport::Contents Snapshot(vtkMRMLFenestraRenderNode* render,
                                  const std::filesystem::path& folder);
  /// Names, tags and colors of the node's segments; empty without a segmentation.
  static std::vector<SlicerExport::Segment> GetSegments(vtkMRMLFenestraRenderNode* render);
  /// The node's flags, and those of its 3D view's camera unless another flag sets the view.
  std::map<std::string, std::string> GetFlags(vtkMRMLFenestraRenderNode* render);
  static std::map<std::string, std::string> GetCameraFlags(vtkMRMLCameraNode* camera);
  /// Reads a result from `folder`; the file names are those of GetArguments. Throws
  /// SlicerExport::FileError. Thread-safe.
  static FenestraResult ReadResult(const std::string& folder);
  /// Adds nodes of the result, referenced by the render: one per step, so that the application
  /// stays responsive. `step`: 0 to ResultSteps - 1. Replaces the frames of a resumed turntable.
  void AddResult(vtkMRMLFenestraRenderNode* render, const FenestraResult& result, int step);
  static constexpr int ResultSteps = 4;
  /// Events of volumes and segmentations after which an image of them may be another one.
  static const std::vector<unsigned long>& GetDataEvents();
#endif

  /// Flag value of a plane of the Markups module; empty: no plane, or not placed yet.
  static std::string GetPlaneFlag(vtkMRMLNode* plane);
  /// Camera of a 3D view; null: none.
  vtkMRMLCameraNode* GetCamera(vtkMRMLViewNode* view);
  /// Camera of the node's 3D view; null: flags set the view.
  vtkMRMLCameraNode* GetFollowedCamera(vtkMRMLFenestraRenderNode* render);
  /// Command-line arguments for rendering the node, with the outputs that ReadResult reads.
  static std::vector<std::string> GetArguments(vtkMRMLFenestraRenderNode* render, bool withSurface);
  /// Finished frames of a turntable in `folder`, from frame 0 to the first missing one.
  static std::vector<std::string> GetFrameFiles(const std::string& folder);

  /// Shows the scene's newest volume in the slice views, which loading a scene does not do.
  void ShowNewestVolume();
  /// Shows the render's image beside a 3D view, in the module's own layout.
  void ShowResult(vtkMRMLFenestraRenderNode* render);
  /// Fits the shown image to its view, and returns to its plane if that was left.
  void AlignView();
  /// Restores the layout that the module's own layout replaced.
  void ShowLayoutBefore();
  /// Render whose image the module's layout shows; null: none.
  vtkMRMLFenestraRenderNode* GetShownRender();
  /// The anatomy that the render's image shows at a pixel, counted from 0 at the upper left: where
  /// half of the light is stopped (without denoising: the mean of the first collisions), RAS, mm.
  /// False: there is nothing, or the image has no depth, such as that of a turntable.
  bool GetImagePoint(vtkMRMLFenestraRenderNode* render, double column, double row, double point[3]);
  /// Moves the slice views and the crosshair to that point. Returns false if there is none.
  bool JumpSlicesToImagePoint(vtkMRMLFenestraRenderNode* render, double column, double row);
  /// The same for a position in the view that shows the image, pixels from the lower left.
  bool JumpSlicesToViewPoint(double x, double y);

  /// Shows another frame of a turntable, in the same view.
  void ShowFrame(vtkMRMLFenestraRenderNode* render, int frame);
  /// Number of frames in the render's image; 1: not a turntable; 0: no image.
  static int GetNumberOfFrames(vtkMRMLFenestraRenderNode* render);

protected:
  vtkSlicerFenestraLogic();
  ~vtkSlicerFenestraLogic() override;
  vtkSlicerFenestraLogic(const vtkSlicerFenestraLogic&) = delete;
  void operator=(const vtkSlicerFenestraLogic&) = delete;

  void RegisterNodes() override;
  void SetMRMLSceneInternal(vtkMRMLScene* scene) override;
  /// Registers the module's layout, which the scene may have been saved with.
  void OnMRMLSceneStartImport() override;
  void OnMRMLSceneEndImport() override;
  void OnMRMLSceneNodeAdded(vtkMRMLNode* node) override;
  void OnMRMLSceneNodeRemoved(vtkMRMLNode* node) override;
  /// A view that the layout has just created changes its size, and sets its plane to its slider's
  /// first value.
  void OnMRMLNodeModified(vtkMRMLNode* node) override;

private:
  vtkMRMLFenestraOpeningNode* AddOpening(vtkMRMLFenestraRenderNode* settings);
  vtkMRMLFenestraOpeningNode* WaitForCut();
  vtkMRMLFenestraOpeningNode* WaitForImage();
  vtkMRMLFenestraRenderNode* Start(vtkMRMLFenestraRenderNode* settings, bool turntable, bool wait);
  vtkMRMLSliceLogic* GetPictureSliceLogic();
  SlicerExport::Matrix MoveOutsideVolume(vtkMRMLFenestraRenderNode* render,
                                         const SlicerExport::Matrix& ijkToRas);
  /// Removes the nodes of a removed render's result; null: none.
  void RemoveResults(vtkMRMLFenestraRenderNode* render);
  void MoveToRenderFolder(vtkMRMLFenestraRenderNode* render, vtkMRMLNode* result);
  void AddDepth(vtkMRMLFenestraRenderNode* render, const SlicerExport::Image& depth);
  void AddSurface(vtkMRMLFenestraRenderNode* render, vtkPolyData* surface);
  void AddFrames(vtkMRMLFenestraRenderNode* render, vtkImageData* frames);
  vtkMRMLVolumeNode* AddVolume(vtkMRMLFenestraRenderNode* render, const char* className,
                               const char* role, vtkImageData* image,
                               const SlicerExport::Matrix& ijkToRas);

  int PreviousLayout = 3;     ///< vtkMRMLLayoutNode::SlicerLayoutFourUpView
  int FittedSize[2] = {0, 0}; ///< of the image's view, pixels
  int ShownFrame = 0;
};

#endif
