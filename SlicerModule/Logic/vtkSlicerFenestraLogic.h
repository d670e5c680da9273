#ifndef __vtkSlicerFenestraLogic_h
#define __vtkSlicerFenestraLogic_h

#include <vtkSlicerModuleLogic.h>

#include <vtkSmartPointer.h>

#include <map>
#include <stdexcept>
#include <string>

#include "FenestraSceneFiles.h"
#include "vtkSlicerFenestraModuleLogicExport.h"

class vtkImageData;
class vtkMRMLCameraNode;
class vtkMRMLFenestraRenderNode;
class vtkMRMLScalarVolumeNode;
class vtkMRMLSegmentationNode;
class vtkMRMLSliceLogic;
class vtkMRMLVolumeNode;
class vtkPolyData;

/// What a render left, read from its files. Of a turntable there is the picture alone, with a
/// frame in each of its slices.
struct vtkSlicerFenestraResult {
  FenestraScene::Image radiance;         ///< linear RGBA, where the picture lies in the world
  FenestraScene::Image depth;            ///< mm from the eye; infinite where nothing is
  vtkSmartPointer<vtkImageData> picture; ///< display colours, row 0 at the top
  vtkSmartPointer<vtkPolyData> surface;  ///< the clipping surface, RAS; none where none clips
};

/// What a user can mend, in one sentence that says how.
struct vtkSlicerFenestraComplaint : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// \brief Between Slicer's scene and the renderer's files.
///
/// Nothing here waits: writing and reading files is for other threads (FenestraScene::Writer,
/// ReadResult), taking what they need and adding what they bring is quick.
class VTK_SLICER_FENESTRA_MODULE_LOGIC_EXPORT vtkSlicerFenestraLogic : public vtkSlicerModuleLogic {
public:
  static vtkSlicerFenestraLogic* New();
  vtkTypeMacro(vtkSlicerFenestraLogic, vtkSlicerModuleLogic);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The settings that the panel edits; made where there are none. A singleton of the scene;
  /// renders are copies of it.
  vtkMRMLFenestraRenderNode* GetSettings();
  /// A node of its own for a render, with the settings as they are now: what a 3-D view's camera
  /// looked at is a fixed view from now on. A turntable's has the settings' flags of turntables.
  vtkMRMLFenestraRenderNode* AddRender(vtkMRMLFenestraRenderNode* settings, bool turntable = false);

  /// Everything that the renderer needs but the flags, without a copy of the voxels. `folder` is
  /// private: what Slicer can only write as files passes through it. Throws
  /// vtkSlicerFenestraComplaint.
  FenestraScene::Contents Snapshot(vtkMRMLFenestraRenderNode* render,
                                   const std::filesystem::path& folder);
  /// The node's flags, with those of its 3-D view's camera where nothing else says where to look
  /// from.
  std::map<std::string, std::string> GetFlags(vtkMRMLFenestraRenderNode* render);
  static std::map<std::string, std::string> GetCameraFlags(vtkMRMLCameraNode* camera);
  /// The flag for a plane of the Markups module; empty where it is none, or not placed yet.
  static std::string GetPlaneFlag(vtkMRMLNode* plane);
  /// The camera of the node's 3-D view; none where the flags fix a view.
  vtkMRMLCameraNode* GetFollowedCamera(vtkMRMLFenestraRenderNode* render);

  /// Of a render into `folder`, under the names of GetArguments. Throws
  /// FenestraScene::FileError. For any thread.
  static vtkSlicerFenestraResult ReadResult(const std::string& folder);
  /// Flags of the command line that make a render of the node, and leave what ReadResult reads.
  static std::vector<std::string> GetArguments(vtkMRMLFenestraRenderNode* render, bool withSurface);
  /// A turntable's finished frames in `folder`, from the first one on.
  static std::vector<std::string> GetFrameFiles(const std::string& folder);
  /// Whether a clipping surface comes with these flags.
  static bool HasSurface(const std::map<std::string, std::string>& flags);

  /// Adds the result's nodes and lets the render refer to them: a node each step, from 0, for the
  /// application can answer its user in between. A turntable that went on shows more frames then.
  void AddResult(vtkMRMLFenestraRenderNode* render, const vtkSlicerFenestraResult& result,
                 int step);
  static constexpr int ResultSteps = 4;
  /// Shows the scene's newest volume in the slice views, which loading a scene leaves as they are.
  void ShowNewestVolume();
  /// Shows the render's picture beside a 3-D view, in a layout of the module's own.
  void ShowResult(vtkMRMLFenestraRenderNode* render);
  /// The one whose picture the user sees in that layout; null: none.
  vtkMRMLFenestraRenderNode* GetShownRender();
  /// Another frame of a turntable, in the same view.
  void ShowFrame(vtkMRMLFenestraRenderNode* render, int frame);
  /// 1 where it is no turntable's; 0 without a picture.
  static int GetNumberOfFrames(vtkMRMLFenestraRenderNode* render);

protected:
  vtkSlicerFenestraLogic();
  ~vtkSlicerFenestraLogic() override;
  vtkSlicerFenestraLogic(const vtkSlicerFenestraLogic&) = delete;
  void operator=(const vtkSlicerFenestraLogic&) = delete;

  void RegisterNodes() override;
  void SetMRMLSceneInternal(vtkMRMLScene* scene) override;
  /// Lets the scene's layout know the module's, in which the scene may have been saved.
  void OnMRMLSceneStartImport() override;

private:
  vtkMRMLSliceLogic* GetPictureView();
  FenestraScene::Matrix BesideAnatomy(vtkMRMLFenestraRenderNode* render,
                                      const FenestraScene::Matrix& ijkToRas);
  void AddSurface(vtkMRMLFenestraRenderNode* render, vtkPolyData* surface);
  void AddFrames(vtkMRMLFenestraRenderNode* render, vtkImageData* frames);
  vtkMRMLVolumeNode* AddVolume(vtkMRMLFenestraRenderNode* render, const char* className,
                               const char* role, vtkImageData* image,
                               const FenestraScene::Matrix& ijkToRas);
};

#endif
