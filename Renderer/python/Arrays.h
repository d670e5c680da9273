#pragma once
// numpy arrays as samples, and memory of the library as numpy arrays, both without a copy.

#include <fenestra/Fenestra.h>

#include <pybind11/numpy.h>

#include <string>
#include <vector>

namespace fenestra::python {

/// The array's memory, which the array must outlive. It has three axes (i, j, k). Throws ValueError
/// for its shape, TypeError for its samples; both name the argument.
Samples makeSamples(const pybind11::array& array, const std::string& argument);

/// The array, or a copy if it repeats one sample: strides of 0 mean packed to the library.
pybind11::array unbroadcast(const pybind11::array& array);

/// Read-only array of the memory of `owner`, which it keeps alive.
template <class T>
pybind11::object viewArray(const T* data, std::vector<pybind11::ssize_t> shape,
                           const pybind11::object& owner) {
  pybind11::array_t<T> array(std::move(shape), data, owner);
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

} // namespace fenestra::python
