#include "integrator/gpu/Pipeline.h"

#include <array>

namespace fenestra::core::gpu {
namespace {

constexpr std::uint32_t shader[] = {
#include "integrator/gpu/PathTracer.inc"
};

VoxelImage makeVoxels(const Device& device, const SimdField& field, std::size_t bytes) {
  const auto count = [&](std::size_t axis) {
    return static_cast<std::uint32_t>(field.axes[axis].last) + 1;
  };
  return device.makeVoxels(field.voxels, {count(0), count(1), count(2)},
                           static_cast<std::uint32_t>(bytes));
}

std::size_t voxelSize(const SimdMedium& medium) {
  return std::visit([](const auto* voxels) { return sizeof(*voxels); }, medium.voxels);
}

/// The focus of the context's style, or one voxel.
VoxelImage makeFocus(const Device& device, const SimdMedium& medium) {
  constexpr std::uint8_t none = 0;
  return makeVoxels(device, medium.context ? medium.context->focus : SimdField{&none, 1, {}}, 1);
}

/// The shader counts bytes of the tables in 32 bits, with a sign.
Buffer makeTables(const Device& device, const std::vector<std::uint32_t>& words) {
  if (words.size() > std::numeric_limits<Int>::max() / sizeof(UInt))
    throw DeviceError("the scene's tables exceed 2 GiB");
  return device.makeBuffer(words.data(), words.size() * sizeof(UInt));
}

} // namespace

Pipeline::Pipeline(std::shared_ptr<const Device> device, const SimdMedium& medium,
                   const SceneTables& scene)
    : m_device(std::move(device)),
      m_scene(m_device->makeBuffer(&scene.numbers, sizeof scene.numbers)),
      m_tables(makeTables(*m_device, scene.words)),
      m_voxels(makeVoxels(*m_device, medium.field, voxelSize(medium))),
      m_focus(makeFocus(*m_device, medium)) {
  createLayout();
  createPipeline(scene.features);
}

void Pipeline::createLayout() {
  std::array<VkDescriptorSetLayoutBinding, bindings> all = {};
  for (std::uint32_t i = 0; i < bindings; ++i)
    all[i] = {.binding = i,
              .descriptorType =
                  isImage(i) ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
              .descriptorCount = 1,
              .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
  const VkDescriptorSetLayoutCreateInfo setInfo = {
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .bindingCount = bindings,
      .pBindings = all.data()};
  VkDescriptorSetLayout set = VK_NULL_HANDLE;
  const VkDevice device = m_device->get();
  check(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &set), "creating a layout");
  m_setLayout = {device, set, vkDestroyDescriptorSetLayout};
  const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push)};
  const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                           .setLayoutCount = 1,
                                           .pSetLayouts = &set,
                                           .pushConstantRangeCount = 1,
                                           .pPushConstantRanges = &push};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device, &info, nullptr, &layout), "creating a layout");
  m_layout = {device, layout, vkDestroyPipelineLayout};
}

void Pipeline::createPipeline(const Features& features) {
  const VkDevice device = m_device->get();
  const VkShaderModuleCreateInfo moduleInfo = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                               .codeSize = sizeof shader,
                                               .pCode = shader};
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device, &moduleInfo, nullptr, &module), "loading the shader");
  const Owned<VkShaderModule> owned(device, module, vkDestroyShaderModule);
  constexpr std::size_t count = sizeof(Features) / sizeof(Int);
  std::array<VkSpecializationMapEntry, count> entries;
  for (std::uint32_t i = 0; i < count; ++i)
    entries[i] = {i, i * std::uint32_t{sizeof(Int)}, sizeof(Int)};
  const VkSpecializationInfo special = {count, entries.data(), sizeof features, &features};
  const VkComputePipelineCreateInfo info = {
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main",
                .pSpecializationInfo = &special},
      .layout = m_layout.get()};
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device, m_device->pipelineCache(), 1, &info, nullptr, &pipeline),
        "compiling the shader");
  m_pipeline = {device, pipeline, vkDestroyPipeline};
}

} // namespace fenestra::core::gpu
