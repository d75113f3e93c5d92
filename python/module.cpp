// SPDX-License-Identifier: BSD-3-Clause
// The module pimg._pimg. Functions take their keywords from the option tables: nothing here lists options.
#include <OpenImageIO/imageio.h>

#include <pimg/detail/format.h>
#include <pimg/display.h>
#include <pimg/version.h>

#include "docs.h"
#include "gain_map.h"
#include "pimg_pvt.h"
#include "progressive.h"

namespace pimg {
namespace python {

namespace {

std::string path_text(const py::object& path)
{
    auto text = py::module_::import("os").attr("fspath")(path).cast<std::string>();
    if (text.find('\0') != text.npos)
        throw py::value_error("path: expected a name without a zero character");
    return text;
}

/// Refuses ProgressiveImage.__new__(): pictures are made by build() and open(), and one made otherwise would hold
/// memory that was never set.
PyObject* refuse_new(PyTypeObject* /*type*/, PyObject* /*arguments*/, PyObject* /*keywords*/)
{
    PyErr_SetString(PyExc_TypeError, "ProgressiveImage: expected pimg.build() or pimg.open() to make one");
    return nullptr;
}

void add_filters(py::module_& module, py::class_<Progressive>& progressive)
{
    for (const Filter& filter : filter_table()) {
        const auto call = [&filter](const py::object& src, const py::object& roi, int nthreads,
                                    const py::kwargs& keys) {
            return run(filter, src, roi, nthreads, to_texts(keys, filter.options()));
        };
        module.def(filter.name, call, py::arg("src"), py::kw_only(), py::arg("roi") = py::none(),
                   py::arg("nthreads") = 0, doc(filter.name, "src").c_str());
        progressive.def(filter.name, call, py::kw_only(), py::arg("roi") = py::none(), py::arg("nthreads") = 0,
                        doc(filter.name, "$self").c_str());
    }
}

void add_building(py::module_& module)
{
    module.def(
        "build",
        [](const py::object& src, const py::object& report, int nthreads, const py::kwargs& keys) {
            return build(src, report, nthreads, to_texts(keys, options_of("build")));
        },
        py::arg("src"), py::kw_only(), py::arg("progress") = py::none(), py::arg("nthreads") = 0,
        doc("build", "src").c_str());
    module.def(
        "open",
        [](const py::object& path, bool array, const py::object& report, int nthreads, const py::kwargs& keys) {
            return open(path_text(path), array, report, nthreads, to_texts(keys, options_of("open")));
        },
        py::arg("path"), py::kw_only(), py::arg("array") = false, py::arg("progress") = py::none(),
        py::arg("nthreads") = 0, doc("open", "path").c_str());
}

void add_progressive(py::class_<Progressive>& type)
{
    type.def(
        "save",
        [](const Progressive& self, const py::object& path, const py::kwargs& keys) {
            save(self, path_text(path), to_texts(keys, options_of("save")));
        },
        py::arg("path"), doc("save", "$self, path").c_str());
    type.def(
        "resolve_hdr_compress",
        [](const Progressive& self, int nthreads, const py::kwargs& keys) {
            return resolve_hdr_compress(self, nthreads, to_texts(keys, options_of("hdr_compress")));
        },
        py::kw_only(), py::arg("nthreads") = 0, doc("resolve_hdr_compress", "$self").c_str());
    type.def_property_readonly(
        "width", [](const Progressive& self) { return self.image.spec().width; }, "pixels");
    type.def_property_readonly(
        "height", [](const Progressive& self) { return self.image.spec().height; }, "pixels");
    type.def_property_readonly(
        "channels", [](const Progressive& self) { return self.image.spec().channelnames; }, "their names");
    type.def_property_readonly(
        "vertices", [](const Progressive& self) { return self.image.hierarchy().vertices(); }, "of the finest mesh");
    type.def_property_readonly(
        "splits", [](const Progressive& self) { return self.image.hierarchy().levels(); },
        "vertex splits from the base mesh to the finest");
    type.def_property_readonly(
        "guide", [](const Progressive& self) { return self.image.stats().guide; },
        "what the mesh follows: luma, log or rgb");
    type.def_property_readonly(
        "memory", [](const Progressive& self) { return self.image.memory(); }, "bytes held, caches included");
    type.def("__repr__", [](const Progressive& self) {
        const OIIO::ImageSpec& spec = self.image.spec();
        return pimg::format("<pimg.ProgressiveImage {} x {} {}, {} splits>", spec.width, spec.height,
                            OIIO::Strutil::join(spec.channelnames, ","), self.image.hierarchy().levels());
    });
}

py::object encode_srgb(const py::object& src, int nthreads, const std::string& layer)
{
    const Picture picture = to_picture(src);
    OIIO::ImageBuf result;
    {
        const py::gil_scoped_release released;
        result = srgb_encoded(*picture.pixels, nthreads, layer);
    }
    if (result.has_error())
        throw py::value_error(result.geterror());
    return to_python(std::move(result), picture.form, picture.pixels->nchannels());
}

std::vector<std::string> filter_names()
{
    std::vector<std::string> names;
    for (const Filter& filter : filter_table())
        names.emplace_back(filter.name);
    return names;
}

/// Makes all functions of OpenImageIO in this process read and write .pimg files, unless the plugin does so already.
void register_format()
{
    static const char* extensions[] = { "pimg", nullptr };
    if (OIIO::is_imageio_format_name("pimg"))
        return;
    OIIO::declare_imageio_format(
        "pimg", [] { return io::make_input().release(); }, extensions,
        [] { return io::make_output(nullptr).release(); }, extensions, nullptr);
}

}  // namespace

void define(py::module_& module)
{
    py::options options;
    options.disable_function_signatures();  // docstring() writes better ones
    register_format();
    module.attr("__version__") = PIMG_VERSION_STRING;
    py::class_<Progressive> progressive(module, "ProgressiveImage",
                                        R"(A picture with its hierarchy, from build() or open().

Filters are methods; results are of the kind of the source. May be used from several threads at once.)");
    reinterpret_cast<PyTypeObject*>(progressive.ptr())->tp_new = refuse_new;
    add_building(module);
    add_filters(module, progressive);
    add_progressive(progressive);
    add_gain_maps(module);
    module.def("srgb_encoded", encode_srgb, py::arg("src"), py::kw_only(), py::arg("nthreads") = 0,
               py::arg("layer") = "",
               R"(srgb_encoded(src, *, nthreads=0, layer="")
--

Linear light for screens and 8-bit files, as float: colours in Rec. 709, whatever primaries the metadata say,
encoded sRGB. `layer` says which channels are the picture, as in build().)");
    module.def(
        "options", [](const std::string& name) { return to_list(options_of(name)); }, py::arg("name"),
        R"(options(name)
--

The options of a filter, of "build", "open", "save" or "gain_map_jpeg", as sliders and dialogs need them.

A list of dicts with name, type, default, min, max, choices, unit and help; None for what there is not.)");
    module.def("filters", filter_names, R"(filters()
--

The names of all filters.)");
}

}  // namespace python
}  // namespace pimg

PYBIND11_MODULE(_pimg, module)
{
    pimg::python::define(module);
}
