// SPDX-License-Identifier: BSD-3-Clause
#include "gain_map.h"

#include <utility>

#include <pimg/gain_map.h>

#include "docs.h"
#include "picture.h"

namespace pimg {
namespace python {

namespace {

py::bytes gain_map_jpeg(const std::string& base, const py::object& rendition, const py::kwargs& keys)
{
    GainMapOptions options;
    std::string file, error;
    const Picture picture = to_picture(rendition);
    bool made = set_options(options, to_texts(keys, describe_options<GainMapOptions>()), error);
    if (made) {
        const py::gil_scoped_release released;
        made = add_gain_map(base, *picture.pixels, options, file, error);
    }
    if (!made)
        throw py::value_error("gain_map_jpeg: " + error);
    return py::bytes(file);
}

py::object rendition_of(const std::string& file, float headroom, bool array)
{
    OIIO::ImageBuf result;
    {
        const py::gil_scoped_release released;
        result = gain_map_rendition(file, headroom);
    }
    if (result.has_error())
        throw py::value_error("gain_map_rendition: " + result.geterror());
    return to_python(std::move(result), Form { array, false }, 3);
}

}  // namespace

void add_gain_maps(py::module_& module)
{
    module.def("gain_map_jpeg", gain_map_jpeg, py::arg("base"), py::arg("rendition"),
               doc("gain_map_jpeg", "base, rendition").c_str());
    module.def("gain_map_rendition", rendition_of, py::arg("file"), py::kw_only(), py::arg("headroom") = -1.0f,
               py::arg("array") = false, R"(gain_map_rendition(file, *, headroom=-1.0, array=False)
--

The HDR rendition of a JPEG file with a gain map (ISO 21496-1 or Ultra HDR): display-linear RGB as float, white of SDR at 1.

Parameters
----------
file : bytes
    The whole file.
headroom : float, in stops
    How much brighter than SDR white the display can be; 0 gives the base, below 0 the whole rendition.
array : bool
    A NumPy array instead of an OpenImageIO.ImageBuf.

Raises
------
ValueError if the bytes are no such file, are cut off, or hold numbers that make no sense.)");
}

}  // namespace python
}  // namespace pimg
