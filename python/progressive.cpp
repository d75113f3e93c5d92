// SPDX-License-Identifier: BSD-3-Clause
#include "progressive.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/oiio_compat.h>
#include <pimg/display.h>
#include <pimg/imagebufalgo.h>

#include "pimg_pvt.h"

namespace pimg {
namespace python {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using pimg::format;

[[noreturn]] void raise(PyObject* type, const std::string& message)
{
    PyErr_SetString(type, one_line(message).c_str());
    throw py::error_already_set();
}

template<class Options>
Options options_from(const OptionTexts& texts)
{
    Options options;
    std::string error;
    if (!set_options(options, texts, error))
        throw py::value_error(one_line(error));
    return options;
}

/// Calls Python's function from the engine, which must not see an exception.
class ProgressReport {
public:
    explicit ProgressReport(const py::object& function) : m_function(function) { }
    bool operator()(float done)
    {
        const py::gil_scoped_acquire gil;
        try {
            if (PyErr_CheckSignals() != 0)
                throw py::error_already_set();
            if (!m_function.is_none())
                m_function(done);
        } catch (py::error_already_set& raised) {
            m_raised.emplace(std::move(raised));
        }
        return !m_raised;
    }
    void rethrow()
    {
        if (m_raised)
            throw std::move(*m_raised);
    }

private:
    const py::object& m_function;
    std::optional<py::error_already_set> m_raised;
};

/// Runs `make(progress)` on `image` with the GIL released.
template<class Make>
void build_with(ProgressiveImage& image, const py::object& progress, Make&& make)
{
    ProgressReport report(progress);
    bool built = false;
    {
        const py::gil_scoped_release released;
        built = make([&](float done) { return report(done); });
    }
    report.rethrow();
    if (!built)
        throw py::value_error(one_line(image.error()));
}

/// Reads a file of another format into memory of our own.
std::shared_ptr<ImageBuf> read_picture(const std::string& filename, std::string& error)
{
    auto pixels = std::make_shared<ImageBuf>(filename);
    if (!pixels->read(0, 0, true))
        error = pixels->geterror();
    return pixels;
}

std::shared_ptr<ImageBuf> read_pimg(OIIO::ImageInput& input, const std::string& filename, std::string& error)
{
    ImageSpec spec;
    if (input.open(filename, spec)) {
        spec.channelformats.clear();
        spec.tile_width = spec.tile_height = 0;
        auto pixels = std::make_shared<ImageBuf>(spec);
        if (input.read_image(0, 0, 0, spec.nchannels, spec.format, pixels->localpixels()))
            return pixels;
    }
    error = input.geterror();
    return nullptr;
}

py::object filtered(const ProgressiveImage& image, Form form, const BoundFilter& filter, OIIO::ROI roi, int nthreads)
{
    // The part of a region outside of the picture has no pixels, and could be of any size.
    const OIIO::ROI whole = OIIO::get_roi(image.spec());
    if (roi.defined()) {
        roi.chend = std::min(roi.chend, whole.chend);
        roi = OIIO::roi_intersection(roi, whole);
        if (roi.width() < 1 || roi.height() < 1)
            throw py::value_error("roi: expected one that overlaps the picture");
    }
    ImageBuf result;
    bool done = false;
    {
        const py::gil_scoped_release released;
        done = filter(result, image, roi, nthreads);
    }
    if (!done)
        throw py::value_error(result.has_error() ? result.geterror() : "the filter failed");
    if (!result.initialized())
        throw py::value_error("roi: expected one that overlaps the picture");
    return to_python(std::move(result), form, image.spec().nchannels);
}

}  // namespace

Progressive build(const py::object& source, const py::object& progress, int nthreads, const OptionTexts& options)
{
    const auto build_options = options_from<BuildOptions>(options);
    const Picture picture = to_picture(source);
    Progressive result;
    result.form = picture.form;
    build_with(result.image, progress, [&](const Progress& report) {
        if (!result.image.build(*picture.pixels, build_options, nthreads, report))
            return false;
        auto copy = std::make_shared<ImageBuf>();
        copy->copy(*picture.pixels);
        result.pixels = std::move(copy);
        return true;
    });
    return result;
}

Progressive open(const std::string& filename, bool array, const py::object& progress, int nthreads,
                 const OptionTexts& options)
{
    const auto build_options = options_from<BuildOptions>(options);
    Progressive result;
    result.form.array = array;
    const bool rebuild =
        std::any_of(options.begin(), options.end(), [](const auto& option) { return option.first != "incolorspace"; });
    std::string error;
    build_with(result.image, progress, [&](const Progress& report) {
        const std::unique_ptr<OIIO::ImageInput> input = io::make_input();
        const bool is_pimg = input->valid_file(filename);
        result.pixels = is_pimg ? read_pimg(*input, filename, error) : read_picture(filename, error);
        if (!error.empty())
            return true;
        OIIO::Filesystem::IOFile proxy(filename, OIIO::Filesystem::IOProxy::Read);
        Decoder decoder;
        if (is_pimg && !rebuild && io::open_decoder(&proxy, decoder) && decoder.has_hierarchy())
            return result.image.adopt(*result.pixels, io::stored_hierarchy(decoder, *result.pixels), build_options,
                                      nthreads);
        return result.image.build(*result.pixels, build_options, nthreads, report);
    });
    if (!error.empty())
        raise(PyExc_OSError, format("cannot read \"{}\": {}", filename, error));
    result.form.flat = array && result.pixels->nchannels() == 1;
    return result;
}

void save(const Progressive& progressive, const std::string& filename, const OptionTexts& options)
{
    io::WriteOptions write_options;
    write_options.profile = "full";
    std::string error;
    if (!set_options(write_options, options, error))
        throw py::value_error(one_line(error));
    if (!OIIO::Strutil::iequals(OIIO::Filesystem::extension(filename), ".pimg"))
        throw py::value_error(format("\"{}\": expected a name that ends in .pimg", filename));
    {
        const py::gil_scoped_release released;
        const ProgressiveImage stored = progressive.image.unwrapped(*progressive.pixels);
        if (!stored.initialized())
            raise(PyExc_OSError, format("cannot write \"{}\": {}", filename, stored.error()));
        const std::unique_ptr<OIIO::ImageOutput> output = io::make_output(&stored.hierarchy());
        ImageSpec spec = progressive.pixels->spec();
        io::add_hints(spec, write_options);
        const std::string& space = progressive.image.options().incolorspace;
        if (!space.empty())
            declare_space(spec, space);
        spec.tile_width = spec.tile_height = 0;
        if (!output->open(filename, spec) || !progressive.pixels->write(output.get()) || !output->close()) {
            error = output->geterror();
            error = error.empty() ? progressive.pixels->geterror() : error;
        }
        // OpenImageIO's cache may still hold the old file of this name.
        forget_in_shared_cache(filename);
    }
    if (!error.empty())
        raise(PyExc_OSError, format("cannot write \"{}\": {}", filename, error));
}

py::object run(const Filter& filter, const py::object& source, const py::object& roi, int nthreads,
               const OptionTexts& options)
{
    BoundFilter bound;
    std::string error;
    if (!filter.bind(options, bound, error))
        throw py::value_error(one_line(error));
    const OIIO::ROI region = to_roi(roi);
    if (py::isinstance<Progressive>(source)) {
        const auto& progressive = source.cast<const Progressive&>();
        return filtered(progressive.image, progressive.form, bound, region, nthreads);
    }
    const Picture picture = to_picture(source);
    ProgressiveImage image;
    build_with(image, py::none(),
               [&](const Progress& report) { return image.build(*picture.pixels, {}, nthreads, report); });
    return filtered(image, picture.form, bound, region, nthreads);
}

py::dict resolve_hdr_compress(const Progressive& progressive, int nthreads, const OptionTexts& texts)
{
    auto options = options_from<HdrCompressOptions>(texts);
    std::string error;
    bool resolved = false;
    {
        const py::gil_scoped_release released;
        resolved = ImageBufAlgo::resolve_hdr_compress(progressive.image, options, error, nthreads);
    }
    if (!resolved)
        throw py::value_error(one_line(error));
    py::dict result;
    for (const Option<HdrCompressOptions>& option : option_table<HdrCompressOptions>())
        result[option.rule.key] =
            std::visit([](const auto& value) { return py::object(py::cast(value)); }, option.get(options));
    return result;
}

}  // namespace python
}  // namespace pimg
