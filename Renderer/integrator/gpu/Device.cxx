#include "integrator/gpu/Device.h"

#include "base/Text.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace fenestra::core::gpu {
namespace {

/// One instance per process, never destroyed: drivers do not expect that at exit. Null without a
/// loader.
VkInstance findInstance() {
  static const VkInstance shared = [] {
    VkInstance instance = VK_NULL_HANDLE;
    if (volkInitialize() != VK_SUCCESS)
      return instance;
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "Fenestra",
                                     .apiVersion = VK_API_VERSION_1_1};
    const VkInstanceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                         .pApplicationInfo = &application};
    if (vkCreateInstance(&create, nullptr, &instance) != VK_SUCCESS)
      return VkInstance(VK_NULL_HANDLE);
    volkLoadInstance(instance);
    return instance;
  }();
  return shared;
}

std::vector<VkPhysicalDevice> listPhysical() {
  const VkInstance instance = findInstance();
  std::uint32_t count = 0;
  if (!instance || vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS)
    return {};
  std::vector<VkPhysicalDevice> devices(count);
  if (vkEnumeratePhysicalDevices(instance, &count, devices.data()) < 0)
    return {};
  devices.resize(count);
  return devices;
}

VkPhysicalDeviceProperties getProperties(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  return properties;
}

/// Order of preference; 0: not used.
int rank(VkPhysicalDeviceType type) {
  const char* const admitted = std::getenv("FENESTRA_GPU");
  switch (type) {
  case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
    return 4;
  case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
    return 3;
  case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
    return 2;
  default:
    return admitted && std::string_view(admitted) == "software" ? 1 : 0;
  }
}

DeviceInfo describe(VkPhysicalDevice physical) {
  const VkPhysicalDeviceProperties properties = getProperties(physical);
  DeviceInfo info{properties.deviceName, concat("version ", properties.driverVersion),
                  properties.deviceType, rank(properties.deviceType) > 0};
  if (properties.apiVersion < VK_API_VERSION_1_2)
    return info;
  VkPhysicalDeviceDriverProperties driver = {
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                     .pNext = &driver};
  vkGetPhysicalDeviceProperties2(physical, &all);
  info.driver = concat(driver.driverName, " ", driver.driverInfo);
  return info;
}

/// Family of queues that compute, preferably without graphics, so that the display stays
/// responsive.
std::uint32_t findFamily(const std::vector<VkQueueFamilyProperties>& families) {
  std::uint32_t best = static_cast<std::uint32_t>(families.size());
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    const VkQueueFlags flags = families[i].queueFlags;
    if (!(flags & VK_QUEUE_COMPUTE_BIT))
      continue;
    if (best == families.size() || !(flags & VK_QUEUE_GRAPHICS_BIT))
      best = i;
    if (!(flags & VK_QUEUE_GRAPHICS_BIT))
      break;
  }
  return best;
}

constexpr VkImageSubresourceRange fullImage = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

void changeLayout(VkCommandBuffer commands, VkImage image, VkAccessFlags before, VkImageLayout from,
                  VkAccessFlags after, VkImageLayout to) {
  const VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                        .srcAccessMask = before,
                                        .dstAccessMask = after,
                                        .oldLayout = from,
                                        .newLayout = to,
                                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .image = image,
                                        .subresourceRange = fullImage};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                       VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

} // namespace

void check(VkResult result, const char* action) {
  if (result < 0)
    throw DeviceError(concat(action, " failed (Vulkan error ", static_cast<int>(result), ")"));
}

std::vector<DeviceInfo> Device::list() {
  std::vector<DeviceInfo> devices;
  for (const VkPhysicalDevice physical : listPhysical())
    devices.push_back(describe(physical));
  return devices;
}

/// The device of open(). Never destroyed: drivers do not expect calls at exit.
struct SharedDevice {
  std::mutex lock;
  std::shared_ptr<const Device> device;
};
static SharedDevice& sharedDevice() {
  static auto* const shared = new SharedDevice;
  return *shared;
}

std::shared_ptr<const Device> Device::open() {
  const std::vector<VkPhysicalDevice> devices = listPhysical();
  const auto rankOf = [](VkPhysicalDevice device) {
    return rank(getProperties(device).deviceType);
  };
  const auto best = std::ranges::max_element(devices, {}, rankOf);
  if (best == devices.end() || rankOf(*best) == 0)
    throw DeviceError(findInstance() ? "no GPU found" : "no Vulkan loader found");
  SharedDevice& shared = sharedDevice();
  const std::lock_guard lock(shared.lock);
  if (!shared.device)
    shared.device = std::shared_ptr<const Device>(new Device(*best));
  return shared.device;
}

void Device::forget() {
  SharedDevice& shared = sharedDevice();
  const std::lock_guard lock(shared.lock);
  shared.device.reset();
}

Device::Device(VkPhysicalDevice physical)
    : m_info(describe(physical)), m_limits(getProperties(physical).limits) {
  vkGetPhysicalDeviceMemoryProperties(physical, &m_memory);
  createQueues(physical);
  const VkPipelineCacheCreateInfo create = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE;
  check(vkCreatePipelineCache(m_device, &create, nullptr, &cache), "opening the device");
  m_pipelineCache = {m_device, cache, vkDestroyPipelineCache};
}

void Device::createQueues(VkPhysicalDevice physical) {
  constexpr std::uint32_t maxQueues = 8;
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  m_family = findFamily(families);
  if (m_family == families.size())
    throw DeviceError("the device cannot compute");
  const std::uint32_t queues = std::min(maxQueues, families[m_family].queueCount);
  const std::array<float, maxQueues> lowest = {};
  const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                         .queueFamilyIndex = m_family,
                                         .queueCount = queues,
                                         .pQueuePriorities = lowest.data()};
  const VkDeviceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue};
  check(vkCreateDevice(physical, &create, nullptr, &m_device), "opening the device");
  m_queues.resize(queues);
  m_queueLocks = std::vector<std::mutex>(queues);
  for (std::uint32_t i = 0; i < queues; ++i)
    vkGetDeviceQueue(m_device, m_family, i, &m_queues[i]);
}

Device::~Device() {
  vkDeviceWaitIdle(m_device);
  m_pipelineCache = {};
  vkDestroyDevice(m_device, nullptr);
}

Owned<VkDeviceMemory> Device::allocate(const VkMemoryRequirements& needed, Memory memory) const {
  constexpr VkMemoryPropertyFlags host =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  // The wanted properties, best first.
  std::vector<VkMemoryPropertyFlags> wanted = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  if (memory == Memory::upload)
    wanted = {host};
  if (memory == Memory::readback)
    wanted = {host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, host};
  for (const VkMemoryPropertyFlags flags : wanted)
    for (std::uint32_t i = 0; i < m_memory.memoryTypeCount; ++i) {
      if (!(needed.memoryTypeBits >> i & 1) ||
          (m_memory.memoryTypes[i].propertyFlags & flags) != flags)
        continue;
      const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                         .allocationSize = needed.size,
                                         .memoryTypeIndex = i};
      VkDeviceMemory allocated = VK_NULL_HANDLE;
      if (vkAllocateMemory(m_device, &info, nullptr, &allocated) == VK_SUCCESS)
        return {m_device, allocated, vkFreeMemory};
    }
  throw DeviceError(concat("too little memory on the device for ", needed.size >> 20, " MiB"));
}

Buffer Device::makeBuffer(VkDeviceSize size, Memory memory) const {
  const VkBufferCreateInfo create = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                     .size = std::max<VkDeviceSize>((size + 15) / 16 * 16, 16),
                                     .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  if (memory == Memory::device && create.size > m_limits.maxStorageBufferRange)
    throw DeviceError(concat("the device allows buffers of at most ",
                             m_limits.maxStorageBufferRange >> 20, " MiB"));
  Buffer made;
  made.size = create.size;
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(m_device, &create, nullptr, &buffer), "creating a buffer");
  Owned<VkBuffer> owned(m_device, buffer, vkDestroyBuffer);
  VkMemoryRequirements needed;
  vkGetBufferMemoryRequirements(m_device, buffer, &needed);
  made.memory = allocate(needed, memory);
  check(vkBindBufferMemory(m_device, buffer, made.memory.get(), 0), "binding a buffer");
  if (memory != Memory::device)
    check(vkMapMemory(m_device, made.memory.get(), 0, VK_WHOLE_SIZE, 0, &made.mapped),
          "mapping a buffer");
  made.buffer = std::move(owned);
  return made;
}

Buffer Device::makeBuffer(const void* content, VkDeviceSize size) const {
  Buffer buffer = makeBuffer(size, Memory::device);
  const Buffer staging = makeBuffer(size, Memory::upload);
  std::memcpy(staging.mapped, content, size);
  Commands(*this).run(0, [&](VkCommandBuffer commands) {
    const VkBufferCopy all = {.size = staging.size};
    vkCmdCopyBuffer(commands, staging.get(), buffer.get(), 1, &all);
  });
  return buffer;
}

Owned<VkImage> Device::makeImage(VkFormat format, const VkExtent3D& extent) const {
  const VkImageCreateInfo create = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_3D,
                                    .format = format,
                                    .extent = extent,
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT};
  VkImage image = VK_NULL_HANDLE;
  check(vkCreateImage(m_device, &create, nullptr, &image), "creating the volume");
  return {m_device, image, vkDestroyImage};
}

VoxelImage Device::makeVoxels(const void* content, const VkExtent3D& extent,
                              std::uint32_t bytes) const {
  if (std::max({extent.width, extent.height, extent.depth}) > m_limits.maxImageDimension3D)
    throw DeviceError(concat("the device allows volumes of at most ", m_limits.maxImageDimension3D,
                             " voxels along an axis"));
  const VkFormat format = bytes == 1   ? VK_FORMAT_R8_UINT
                          : bytes == 2 ? VK_FORMAT_R16_UINT
                                       : VK_FORMAT_R32_UINT;
  Owned<VkImage> image = makeImage(format, extent);
  VkMemoryRequirements needed;
  vkGetImageMemoryRequirements(m_device, image.get(), &needed);
  VoxelImage made;
  made.memory = allocate(needed, Memory::device);
  check(vkBindImageMemory(m_device, image.get(), made.memory.get(), 0), "binding the volume");
  copyVoxels(content, extent, bytes, image.get());
  const VkImageViewCreateInfo viewInfo = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                          .image = image.get(),
                                          .viewType = VK_IMAGE_VIEW_TYPE_3D,
                                          .format = format,
                                          .subresourceRange = fullImage};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(m_device, &viewInfo, nullptr, &view), "viewing the volume");
  made.image = std::move(image);
  made.view = {m_device, view, vkDestroyImageView};
  return made;
}

/// In slabs, so that staging takes little memory.
void Device::copyVoxels(const void* content, const VkExtent3D& extent, std::uint32_t bytes,
                        VkImage image) const {
  constexpr VkDeviceSize maxStaging = VkDeviceSize{64} << 20;
  const VkDeviceSize slice = VkDeviceSize{extent.width} * extent.height * bytes;
  const auto slices =
      static_cast<std::uint32_t>(std::clamp<VkDeviceSize>(maxStaging / slice, 1, extent.depth));
  const Buffer staging = makeBuffer(slice * slices, Memory::upload);
  const Commands once(*this);
  for (std::uint32_t z = 0; z < extent.depth; z += slices) {
    const std::uint32_t count = std::min(slices, extent.depth - z);
    std::memcpy(staging.mapped, static_cast<const std::byte*>(content) + z * slice, count * slice);
    once.run(0, [&](VkCommandBuffer commands) {
      if (z == 0)
        changeLayout(commands, image, 0, VK_IMAGE_LAYOUT_UNDEFINED, VK_ACCESS_TRANSFER_WRITE_BIT,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageOffset = {0, 0, static_cast<std::int32_t>(z)},
                                      .imageExtent = {extent.width, extent.height, count}};
      vkCmdCopyBufferToImage(commands, staging.get(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             1, &copy);
      if (z + count == extent.depth)
        changeLayout(commands, image, VK_ACCESS_TRANSFER_WRITE_BIT,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_ACCESS_SHADER_READ_BIT,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    });
  }
}

void Device::submit(std::size_t queue, VkCommandBuffer commands, VkFence fence) const {
  const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                             .commandBufferCount = 1,
                             .pCommandBuffers = &commands};
  const std::lock_guard lock(m_queueLocks[queue]);
  check(vkQueueSubmit(m_queues[queue], 1, &info, fence), "starting the device");
}

Commands::Commands(const Device& device) : m_device(device) {
  const VkCommandPoolCreateInfo poolInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .flags =
                                                VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                            .queueFamilyIndex = device.family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device.get(), &poolInfo, nullptr, &pool), "creating commands");
  m_pool = {device.get(), pool, vkDestroyCommandPool};
  const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
  check(vkAllocateCommandBuffers(device.get(), &info, &m_buffer), "creating commands");
  const VkFenceCreateInfo fenceInfo = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(device.get(), &fenceInfo, nullptr, &fence), "creating a fence");
  m_fence = {device.get(), fence, vkDestroyFence};
}

void Commands::begin() const {
  const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(m_buffer, &info), "recording commands");
}

void Commands::submit(std::size_t queue) const {
  check(vkEndCommandBuffer(m_buffer), "recording commands");
  check(vkResetFences(m_device.get(), 1, m_fence.address()), "resetting a fence");
  m_device.submit(queue, m_buffer, m_fence.get());
  check(vkWaitForFences(m_device.get(), 1, m_fence.address(), VK_TRUE, UINT64_MAX),
        "waiting for the device");
}

} // namespace fenestra::core::gpu
