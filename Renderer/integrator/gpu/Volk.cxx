// The implementation of volk, which opens the Vulkan loader.
#define VOLK_IMPLEMENTATION
#include <volk.h>
