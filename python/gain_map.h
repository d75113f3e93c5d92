// SPDX-License-Identifier: BSD-3-Clause
// Gain-map JPEG files as bytes.
#pragma once

#include <pybind11/pybind11.h>

namespace pimg {
namespace python {

/// Adds gain_map_jpeg() and gain_map_rendition() to the module.
void add_gain_maps(pybind11::module_& module);

}  // namespace python
}  // namespace pimg
