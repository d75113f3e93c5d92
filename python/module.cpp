// SPDX-License-Identifier: BSD-3-Clause
// The module pimg._pimg. Functions take their keywords from the option tables: nothing here lists options.
#include <OpenImageIO/imageio.h>
#include <pimg/display.h>
#include <pimg/version.h>

#include "docs.h"
#include "pimg_pvt.h"
#include "progressive.h"

namespace pimg {
namespace python {

namespace {

const char* const kSource
    = "The source is an OpenImageIO.ImageBuf, or a NumPy array of shape (height, width) or (height, width, channels): uint8,\n"
      "uint16 and float16, float32, float64 (scene-linear light, any range; uint8 is taken as sRGB). The result is of the\n"
      "same kind. A hierarchy is built on the way: if there will be more than one result, build() it once.\n";

const char* const kCommon
    = "roi : OpenImageIO.ROI or (xbegin, xend, ybegin, yend)\n"
      "    only this part is made, just as it is in the whole result\n"
      "nthreads : int, default 0\n"
      "    threads to use; 0: OpenImageIO's attribute \"threads\". Never changes a result\n";

const char* const kRaises
    = "\nRaises\n------\nValueError\n    for an option out of range or a picture that cannot be filtered\nTypeError\n"
      "    for an unknown keyword or another kind of source\n";

std::string filter_doc(const Filter& filter, bool method)
{
    const FilterText& text = text_of(filter);
    const std::string before = std::string(text.description) + "\n\n" + (method ? "" : kSource) + "The GIL is released.";
    return docstring(filter.name, method ? "$self" : "src", ", roi=None, nthreads=0", filter.options(), before,
                     kCommon + std::string("\nReturns\n-------\n") + text.result + "\n" + kRaises);
}

/// "build" and "save" have options, too.
std::vector<OptionInfo> options_of(const std::string& name)
{
    if (name == "build")
        return describe_options<BuildOptions>();
    if (name == "save") {
        std::vector<OptionInfo> options = describe_options<io::WriteOptions>();
        options[0].default_value = "full";
        return options;
    }
    std::string error;
    const Filter* filter = find_filter(name, error);
    if (filter == nullptr)
        throw py::value_error(error + ", build, save");
    return filter->options();
}

std::string path_text(const py::object& path)
{
    return py::module_::import("os").attr("fspath")(path).cast<std::string>();
}

void add_filters(py::module_& module, py::class_<Progressive>& progressive)
{
    for (const Filter& filter : filter_table()) {
        const auto call = [&filter](const py::object& src, const py::object& roi, int nthreads, const py::kwargs& keys) {
            return run(filter, src, roi, nthreads, to_texts(keys, filter.options()));
        };
        module.def(filter.name, call, py::arg("src"), py::kw_only(), py::arg("roi") = py::none(),
                   py::arg("nthreads") = 0, filter_doc(filter, false).c_str());
        progressive.def(filter.name, call, py::kw_only(), py::arg("roi") = py::none(), py::arg("nthreads") = 0,
                        filter_doc(filter, true).c_str());
    }
}

void add_building(py::module_& module)
{
    const std::vector<OptionInfo> options = options_of("build");
    const std::string progress
        = "progress : callable\n    called now and then with the share done, 0 to 1; an exception stops the work\n"
          "nthreads : int, default 0\n    threads to use; 0: OpenImageIO's attribute \"threads\"\n"
          "\nReturns\n-------\nProgressiveImage\n";
    module.def(
        "build",
        [](const py::object& src, const py::object& report, int nthreads, const py::kwargs& keys) {
            return build(src, report, nthreads, to_texts(keys, options_of("build")));
        },
        py::arg("src"), py::kw_only(), py::arg("progress") = py::none(), py::arg("nthreads") = 0,
        docstring("build", "src", ", progress=None, nthreads=0", options,
                  "Builds the hierarchy of a picture, on which every filter then takes one sweep.\n\n"
                  "The source is an OpenImageIO.ImageBuf, or a NumPy array of shape (height, width) or (height, width,\n"
                  "channels); results will be of the same kind. It is copied. The GIL is released.",
                  progress + kRaises)
            .c_str());
    module.def(
        "open",
        [](const py::object& path, bool array, const py::object& report, int nthreads, const py::kwargs& keys) {
            return open(path_text(path), array, report, nthreads, to_texts(keys, options_of("build")));
        },
        py::arg("path"), py::kw_only(), py::arg("array") = false, py::arg("progress") = py::none(),
        py::arg("nthreads") = 0,
        docstring("open", "path", ", array=False, progress=None, nthreads=0", options,
                  "Reads a picture from any file OpenImageIO knows. From a .pimg file of the full profile the hierarchy is read,\n"
                  "too, unless options ask for another; else it is built. The GIL is released.",
                  "array : bool, default False\n    results are NumPy arrays instead of OpenImageIO.ImageBuf\n" + progress
                      + "\nRaises\n------\nOSError\n    if the file cannot be read\n")
            .c_str());
}

void add_progressive(py::class_<Progressive>& type)
{
    type.def(
        "save",
        [](const Progressive& self, const py::object& path, const py::kwargs& keys) {
            save(self, path_text(path), to_texts(keys, options_of("save")));
        },
        py::arg("path"),
        docstring("save", "$self, path", "", options_of("save"),
                  "Writes a .pimg file: the picture, exactly, and the hierarchy, so that open() need not build it.",
                  "\nRaises\n------\nOSError\n    if the file cannot be written; nothing is left behind\n")
            .c_str());
    type.def(
        "resolve_hdr_compress",
        [](const Progressive& self, int nthreads, const py::kwargs& keys) {
            return resolve_hdr_compress(self, nthreads, to_texts(keys, options_of("hdr_compress")));
        },
        py::kw_only(), py::arg("nthreads") = 0,
        docstring("resolve_hdr_compress", "$self", ", nthreads=0", options_of("hdr_compress"),
                  "The options of hdr_compress() with every value it finds from the picture written in. The frames of a shot\n"
                  "made with those of one frame do not flicker.",
                  "\nReturns\n-------\ndict\n")
            .c_str());
    type.def_property_readonly("width", [](const Progressive& self) { return self.image.spec().width; }, "pixels");
    type.def_property_readonly("height", [](const Progressive& self) { return self.image.spec().height; }, "pixels");
    type.def_property_readonly("channels", [](const Progressive& self) { return self.image.spec().channelnames; },
                               "their names");
    type.def_property_readonly("vertices", [](const Progressive& self) { return self.image.hierarchy().vertices(); },
                               "of the finest mesh");
    type.def_property_readonly("splits", [](const Progressive& self) { return self.image.hierarchy().levels(); },
                               "vertex splits from the base mesh to the finest");
    type.def_property_readonly("guide", [](const Progressive& self) { return self.image.stats().guide; },
                               "what the mesh follows: luma, log or rgb");
    type.def_property_readonly("memory", [](const Progressive& self) { return self.image.memory(); },
                               "bytes held, caches included");
    type.def("__repr__", [](const Progressive& self) {
        const OIIO::ImageSpec& spec = self.image.spec();
        return OIIO::Strutil::fmt::format("<pimg.ProgressiveImage {} x {} {}, {} splits>", spec.width, spec.height,
                                          OIIO::Strutil::join(spec.channelnames, ","), self.image.hierarchy().levels());
    });
}

py::object encode_srgb(const py::object& src, int nthreads)
{
    const Picture picture = to_picture(src);
    OIIO::ImageBuf result;
    {
        const py::gil_scoped_release released;
        result = srgb_encoded(*picture.pixels, nthreads);
    }
    if (result.has_error())
        throw py::value_error(result.geterror());
    return to_python(std::move(result), picture.form, picture.pixels->nchannels());
}

/// .pimg files in every function of OpenImageIO in this process, unless the plugin is there already.
void register_format()
{
    static const char* extensions[] = { "pimg", nullptr };
    if (OIIO::is_imageio_format_name("pimg"))
        return;
    OIIO::declare_imageio_format(
        "pimg", [] { return io::make_input().release(); }, extensions, [] { return io::make_output(nullptr).release(); },
        extensions, nullptr);
}

}  // namespace

void define(py::module_& module)
{
    py::options options;
    options.disable_function_signatures();  // docstring() writes better ones
    register_format();
    module.attr("__version__") = PIMG_VERSION_STRING;
    py::class_<Progressive> progressive(module, "ProgressiveImage",
                                        "A picture with its hierarchy, from build() or open(). Filters are methods; results are of the kind of\n"
                                        "the source. May be used from several threads at once.");
    add_building(module);
    add_filters(module, progressive);
    add_progressive(progressive);
    module.def("srgb_encoded", encode_srgb, py::arg("src"), py::kw_only(), py::arg("nthreads") = 0,
               "srgb_encoded(src, *, nthreads=0)\n--\n\nThe colour channels of linear light with the sRGB curve on them, float: for "
               "screens and 8-bit files.");
    module.def(
        "options", [](const std::string& name) { return to_list(options_of(name)); }, py::arg("name"),
        "options(name)\n--\n\nThe options of a filter, of \"build\" or \"save\": a list of dicts with name, type, default, min, max,\n"
        "choices, unit and help; None for what there is not. What sliders are made of.");
    module.def(
        "filters",
        [] {
            std::vector<std::string> names;
            for (const Filter& filter : filter_table())
                names.emplace_back(filter.name);
            return names;
        },
        "filters()\n--\n\nThe names of all filters.");
}

}  // namespace python
}  // namespace pimg

PYBIND11_MODULE(_pimg, module)
{
    pimg::python::define(module);
}
