// SPDX-License-Identifier: BSD-3-Clause
// The class ProgressiveImage of Python: a picture, its hierarchy, and what kind of pictures it makes.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <pimg/filter_table.h>

#include "picture.h"

namespace pimg {
namespace python {

struct Progressive {
    ProgressiveImage image;
    std::shared_ptr<const OIIO::ImageBuf> pixels;  ///< as they came, for save()
    Form form;
};

/// Builds with the GIL released. `progress`: None or a function of the share done, called now and then; what it raises,
/// and Ctrl-C, end the work.
Progressive build(const py::object& source, const py::object& progress, int nthreads, const OptionTexts& options);

/// Takes the hierarchy from the file if there is one and no option asks for another.
Progressive open(const std::string& filename, bool array, const py::object& progress, int nthreads,
                 const OptionTexts& options);

/// Writes a .pimg file with the hierarchy in it.
void save(const Progressive& progressive, const std::string& filename, const OptionTexts& options);

/// Runs a filter with the GIL released. `source` may also be a picture, for which a hierarchy is built.
py::object run(const Filter& filter, const py::object& source, const py::object& roi, int nthreads,
               const OptionTexts& options);

/// The options of hdr_compress with everything it finds from the picture written in.
py::dict resolve_hdr_compress(const Progressive& progressive, int nthreads, const OptionTexts& options);

}  // namespace python
}  // namespace pimg
