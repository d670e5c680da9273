#include "python/Arrays.h"

#include <algorithm>

namespace fenestra::python {
namespace {

namespace py = pybind11;

/// Throws TypeError, which names the argument.
SampleType findSampleType(const py::dtype& type, const std::string& argument) {
  const struct {
    const char* kinds;
    py::ssize_t bytes;
    SampleType type;
  } table[] = {{"i", 1, SampleType::int8},    {"ub", 1, SampleType::uint8},
               {"i", 2, SampleType::int16},   {"u", 2, SampleType::uint16},
               {"i", 4, SampleType::int32},   {"u", 4, SampleType::uint32},
               {"i", 8, SampleType::int64},   {"u", 8, SampleType::uint64},
               {"f", 4, SampleType::float32}, {"f", 8, SampleType::float64}};
  for (const auto& row : table)
    if (std::string(row.kinds).find(type.kind()) != std::string::npos &&
        row.bytes == type.itemsize())
      return row.type;
  throw py::type_error(argument + ": samples of type " +
                       py::str(py::handle(type)).cast<std::string>() +
                       " are not supported; convert them to integers, float32 or float64");
}

} // namespace

Samples makeSamples(const py::array& array, const std::string& argument) {
  if (array.ndim() != 3 || array.size() == 0)
    throw py::value_error(argument + ": an array of shape " +
                          py::str(array.attr("shape")).cast<std::string>() +
                          " is no volume; three axes of 1 or more voxels are needed");
  Samples samples;
  samples.data = array.data();
  samples.type = findSampleType(array.dtype(), argument);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    samples.size[axis] = array.shape(static_cast<py::ssize_t>(axis));
    samples.strides[axis] = array.strides(static_cast<py::ssize_t>(axis));
  }
  samples.isSwapped = !array.dtype().attr("isnative").cast<bool>();
  return samples;
}

py::array unbroadcast(const py::array& array) {
  const bool hasStride = std::any_of(array.strides(), array.strides() + array.ndim(),
                                     [](py::ssize_t stride) { return stride != 0; });
  return hasStride ? array : py::array(array.attr("copy")());
}

} // namespace fenestra::python
