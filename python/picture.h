// SPDX-License-Identifier: BSD-3-Clause
// Pictures as Python has them, and as C++ has them.
#pragma once

#include <memory>

#include <OpenImageIO/imagebuf.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

namespace pimg {
namespace python {

namespace py = pybind11;

/// What a result becomes: an OpenImageIO.ImageBuf or, from an array, an array with as many dimensions.
struct Form {
    bool array = false;
    bool flat = false;  ///< rows of samples, without an axis of channels
};

/// A picture over memory of Python's; `owner` keeps that alive.
struct Picture {
    std::shared_ptr<const OIIO::ImageBuf> pixels;
    Form form;
    py::object owner;
};

/// From an ImageBuf or an array of shape (height, width) or (height, width, channels). TypeError or ValueError for all
/// else.
Picture to_picture(py::object object);

/// The result of a filter on a picture of that form. One channel made from several, such as labels, has no axis of
/// channels.
py::object to_python(OIIO::ImageBuf result, Form form, int channels_of_source);

/// From None, an OpenImageIO.ROI or (xbegin, xend, ybegin, yend).
OIIO::ROI to_roi(const py::object& object);

}  // namespace python
}  // namespace pimg
