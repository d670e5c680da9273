#pragma once
// A Vulkan device: its choice, memory and commands. The loader is opened at run time, so that
// Fenestra runs without it. Only this folder uses Vulkan.

#include <volk.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fenestra::core::gpu {

/// A call of Vulkan failed, or the device's memory does not suffice. A scene then needs the CPU.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws DeviceError, with `action`, unless the result is a success.
void check(VkResult result, const char* action);

/// An object of a device, destroyed with it. Must not outlive the device.
template <typename Handle>
class Owned {
public:
  using Destroy = void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*);

  Owned() = default;
  Owned(VkDevice device, Handle handle, Destroy destroy)
      : m_device(device), m_handle(handle), m_destroy(destroy) {}
  Owned(Owned&& other) noexcept
      : m_device(other.m_device),
        m_handle(std::exchange(other.m_handle, VK_NULL_HANDLE)),
        m_destroy(other.m_destroy) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(m_device, other.m_device);
    std::swap(m_handle, other.m_handle);
    std::swap(m_destroy, other.m_destroy);
    return *this;
  }
  ~Owned() {
    if (m_handle)
      m_destroy(m_device, m_handle, nullptr);
  }

  Handle get() const { return m_handle; }
  /// Address of the handle, for arrays of one.
  const Handle* address() const { return &m_handle; }

private:
  VkDevice m_device = VK_NULL_HANDLE;
  Handle m_handle = VK_NULL_HANDLE;
  Destroy m_destroy = nullptr;
};

/// Where a buffer lies, and which side writes it.
enum class Memory {
  device,  ///< not visible to the host
  upload,  ///< mapped; written by the host, once
  readback ///< mapped and cached; read by the host
};

struct Buffer {
  Owned<VkDeviceMemory> memory;
  Owned<VkBuffer> buffer; ///< before `memory` in destruction
  VkDeviceSize size = 0;  ///< bytes
  void* mapped = nullptr;

  VkBuffer get() const { return buffer.get(); }
};

/// A 3D image of unsigned integers, for reading by shaders.
struct VoxelImage {
  Owned<VkDeviceMemory> memory;
  Owned<VkImage> image;
  Owned<VkImageView> view;
};

struct DeviceInfo {
  std::string name, driver;
  VkPhysicalDeviceType type;
  bool isUsed; ///< open() may choose it

  /// What images record: those of the same device and driver are bit-identical.
  std::string target() const { return name + ", " + driver; }
};

class Device {
public:
  /// Devices of the machine; empty without a loader.
  static std::vector<DeviceInfo> list();
  /// The best device: discrete before integrated ones. Software devices count only if the
  /// environment variable FENESTRA_GPU is "software". All renders of the process share it, since
  /// opening one takes long. Throws DeviceError.
  static std::shared_ptr<const Device> open();
  /// Lets the next call of open() open the device again, after an error.
  static void forget();

  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();

  const DeviceInfo& info() const { return m_info; }
  bool isSoftware() const { return m_info.type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  VkDevice get() const { return m_device; }
  const VkPhysicalDeviceLimits& limits() const { return m_limits; }
  std::uint32_t family() const { return m_family; }
  VkPipelineCache pipelineCache() const { return m_pipelineCache.get(); }
  std::size_t queueCount() const { return m_queues.size(); }

  Buffer makeBuffer(VkDeviceSize size, Memory memory) const;
  /// Device buffer with the given content.
  Buffer makeBuffer(const void* content, VkDeviceSize size) const;
  /// `bytes`: per voxel, 1, 2 or 4.
  VoxelImage makeVoxels(const void* content, const VkExtent3D& extent, std::uint32_t bytes) const;
  /// Submits commands to one of the queues, and returns at once.
  void submit(std::size_t queue, VkCommandBuffer commands, VkFence fence) const;

private:
  explicit Device(VkPhysicalDevice physical);
  void createQueues(VkPhysicalDevice physical);
  Owned<VkImage> makeImage(VkFormat format, const VkExtent3D& extent) const;
  void copyVoxels(const void* content, const VkExtent3D& extent, std::uint32_t bytes,
                  VkImage image) const;
  Owned<VkDeviceMemory> allocate(const VkMemoryRequirements& needed, Memory memory) const;

  DeviceInfo m_info;
  VkPhysicalDeviceLimits m_limits = {};
  VkPhysicalDeviceMemoryProperties m_memory = {};
  VkDevice m_device = VK_NULL_HANDLE;
  std::uint32_t m_family = 0;
  std::vector<VkQueue> m_queues;
  Owned<VkPipelineCache> m_pipelineCache; ///< compiled shaders of earlier renders
  mutable std::vector<std::mutex> m_queueLocks;
};

/// A command buffer that is recorded and run again and again. Must not outlive the device.
class Commands {
public:
  /// Throws DeviceError.
  explicit Commands(const Device& device);

  /// Records commands by record(buffer), runs them on a queue and waits for their end. Throws
  /// DeviceError.
  template <typename Record>
  void run(std::size_t queue, Record&& record) const {
    begin();
    record(m_buffer);
    submit(queue);
  }

private:
  void begin() const;
  void submit(std::size_t queue) const;

  const Device& m_device;
  Owned<VkCommandPool> m_pool;
  Owned<VkFence> m_fence;
  VkCommandBuffer m_buffer = VK_NULL_HANDLE;
};

} // namespace fenestra::core::gpu
