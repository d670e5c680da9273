#include "integrator/gpu/BatchTracer.h"

#include "base/Stopwatch.h"

#include <algorithm>
#include <array>

namespace fenestra::core::gpu {
namespace {

constexpr std::uint32_t groupSize = 64; ///< threads; local_size_x of PathTracer.comp

void addBarrier(VkCommandBuffer commands, VkAccessFlags from, VkAccessFlags to) {
  constexpr VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                          VK_PIPELINE_STAGE_TRANSFER_BIT |
                                          VK_PIPELINE_STAGE_HOST_BIT;
  const VkMemoryBarrier barrier = {
      .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = from, .dstAccessMask = to};
  vkCmdPipelineBarrier(commands, stages, stages, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

} // namespace

BatchTracer::BatchTracer(const Pipeline& pipeline, std::size_t queue, const BatchLimits& limits)
    : m_pipeline(pipeline),
      m_queue(queue),
      m_limits(limits),
      m_steps(std::min(limits.maxSteps, 256)),
      m_commands(pipeline.device()) {
  const Device& device = pipeline.device();
  m_starts = device.makeBuffer(limits.paths * sizeof(PathStart), Memory::upload);
  m_deviceStarts = device.makeBuffer(m_starts.size, Memory::device);
  m_results = device.makeBuffer(limits.paths * sizeof(PathResult), Memory::readback);
  m_deviceResults = device.makeBuffer(m_results.size, Memory::device);
  m_states = device.makeBuffer(limits.threads * VkDeviceSize{stateBytes}, Memory::device);
  m_work = device.makeBuffer(sizeof(Work), Memory::readback);
  bindBuffers();
}

void BatchTracer::bindBuffers() {
  const VkDevice device = m_pipeline.device().get();
  constexpr std::array<VkDescriptorPoolSize, 2> sizes = {
      {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, Pipeline::bindings - 2},
       {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2}}};
  const VkDescriptorPoolCreateInfo poolInfo = {.sType =
                                                   VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                               .maxSets = 1,
                                               .poolSizeCount = sizes.size(),
                                               .pPoolSizes = sizes.data()};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &poolInfo, nullptr, &pool), "creating descriptors");
  m_descriptors = {device, pool, vkDestroyDescriptorPool};
  const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = m_pipeline.setLayout()};
  check(vkAllocateDescriptorSets(device, &info, &m_set), "creating descriptors");

  const std::array<VkBuffer, Pipeline::bindings> buffers = {m_pipeline.scene().get(),
                                                            m_pipeline.tables().get(),
                                                            VK_NULL_HANDLE,
                                                            m_deviceStarts.get(),
                                                            m_deviceResults.get(),
                                                            m_states.get(),
                                                            m_work.get(),
                                                            VK_NULL_HANDLE};
  std::array<VkDescriptorImageInfo, Pipeline::bindings> images;
  std::array<VkDescriptorBufferInfo, Pipeline::bindings> infos;
  std::array<VkWriteDescriptorSet, Pipeline::bindings> writes = {};
  for (std::uint32_t i = 0; i < Pipeline::bindings; ++i) {
    infos[i] = {buffers[i], 0, VK_WHOLE_SIZE};
    images[i] = {VK_NULL_HANDLE, i == Pipeline::volume ? m_pipeline.voxels() : m_pipeline.focus(),
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = m_set,
                 .dstBinding = i,
                 .descriptorCount = 1,
                 .descriptorType = Pipeline::isImage(i) ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                                                        : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                 .pImageInfo = &images[i],
                 .pBufferInfo = &infos[i]};
  }
  vkUpdateDescriptorSets(device, Pipeline::bindings, writes.data(), 0, nullptr);
}

bool BatchTracer::run(std::size_t count, const StopFlag& stop, Counters& counters) {
  auto* const work = static_cast<Work*>(m_work.mapped);
  const auto run = [&](auto&& record) { m_commands.run(m_queue, record); };
  *work = {};
  run([&](VkCommandBuffer commands) { recordBegin(commands, count); });
  do {
    if (stop.load(std::memory_order_relaxed))
      return false;
    *work = {.nextPath = work->nextPath};
    const Stopwatch watch;
    run([&](VkCommandBuffer commands) { recordDispatch(commands, count); });
    adaptSteps(watch.seconds());
    addCounts(counters);
  } while (work->unfinished > 0 || work->nextPath < static_cast<std::int32_t>(count));
  run([&](VkCommandBuffer commands) { recordEnd(commands, count); });
  counters.paths += count;
  return true;
}

void BatchTracer::recordBegin(VkCommandBuffer commands, std::size_t count) const {
  // The host has waited for the batch before. The barrier makes the commands correct without that
  // wait, too: once in a while the validation layer reported it as missing, with several threads.
  addBarrier(commands, VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_WRITE_BIT,
             VK_ACCESS_TRANSFER_WRITE_BIT);
  const VkBufferCopy copy = {.size = count * sizeof(PathStart)};
  vkCmdCopyBuffer(commands, m_starts.get(), m_deviceStarts.get(), 1, &copy);
  // All threads are idle; this also discards the paths of a batch that was stopped.
  vkCmdFillBuffer(commands, m_states.get(), 0, VK_WHOLE_SIZE, 0);
}

void BatchTracer::recordDispatch(VkCommandBuffer commands, std::size_t count) const {
  addBarrier(commands, VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_WRITE_BIT,
             VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m_pipeline.get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m_pipeline.layout(), 0, 1,
                          &m_set, 0, nullptr);
  const auto paths = static_cast<std::uint32_t>(count);
  const Pipeline::Push push = {static_cast<std::int32_t>(paths), m_steps};
  vkCmdPushConstants(commands, m_pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push,
                     &push);
  vkCmdDispatch(commands, (std::min(m_limits.threads, paths) + groupSize - 1) / groupSize, 1, 1);
  addBarrier(commands, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT);
}

void BatchTracer::recordEnd(VkCommandBuffer commands, std::size_t count) const {
  addBarrier(commands, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT);
  const VkBufferCopy copy = {.size = count * sizeof(PathResult)};
  vkCmdCopyBuffer(commands, m_deviceResults.get(), m_results.get(), 1, &copy);
  addBarrier(commands, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT);
}

/// Keeps the time of a dispatch near 20 ms, so that displays stay responsive and stops are quick.
void BatchTracer::adaptSteps(double seconds) {
  constexpr double target = 0.02;
  const double factor = std::clamp(target / std::max(seconds, 1e-4), 0.5, 2.0);
  const std::int32_t least = std::min(32, m_limits.maxSteps);
  m_steps = std::clamp(static_cast<std::int32_t>(m_steps * factor), least, m_limits.maxSteps);
}

void BatchTracer::addCounts(Counters& counters) const {
  const Work& work = *static_cast<const Work*>(m_work.mapped);
  counters.collisions += work.counts[collisionCount];
  counters.lookups += work.counts[lookupCount];
  counters.cells += work.counts[cellCount];
  counters.skippedCells += work.counts[skippedCellCount];
  counters.shadowRays += work.counts[shadowRayCount];
  counters.gradients += work.counts[gradientCount];
}

} // namespace fenestra::core::gpu
