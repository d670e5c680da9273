#pragma once
// A scene on a device: its tables and voxels, and the shader, specialized for the scene.

#include "integrator/gpu/Device.h"
#include "integrator/gpu/SceneTables.h"

namespace fenestra::core::gpu {

class Pipeline {
public:
  /// Copies the scene to the device. Throws DeviceError.
  Pipeline(std::shared_ptr<const Device> device, const SimdMedium& medium,
           const SceneTables& scene);

  const Device& device() const { return *m_device; }
  VkPipeline get() const { return m_pipeline.get(); }
  VkPipelineLayout layout() const { return m_layout.get(); }
  const VkDescriptorSetLayout* setLayout() const { return m_setLayout.address(); }
  const Buffer& scene() const { return m_scene; }
  const Buffer& tables() const { return m_tables; }
  VkImageView voxels() const { return m_voxels.view.get(); }
  VkImageView focus() const { return m_focus.view.get(); }

  /// Bindings of PathTracer.comp.
  enum Binding : std::uint32_t {
    scenes,
    words,
    volume,
    starts,
    results,
    states,
    work,
    focusMask,
    bindings
  };
  static constexpr bool isImage(std::uint32_t binding) {
    return binding == volume || binding == focusMask;
  }
  /// Push constants of PathTracer.comp.
  struct Push {
    std::int32_t pathCount, maxSteps;
  };

private:
  void createLayout();
  void createPipeline(const Features& features);

  std::shared_ptr<const Device> m_device;
  Buffer m_scene, m_tables;
  VoxelImage m_voxels, m_focus;
  Owned<VkDescriptorSetLayout> m_setLayout;
  Owned<VkPipelineLayout> m_layout;
  Owned<VkPipeline> m_pipeline;
};

} // namespace fenestra::core::gpu
