// SPDX-License-Identifier: BSD-3-Clause
#include "picture.h"

#include <pimg/detail/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>
#include <vector>

namespace pimg {
namespace python {

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using pimg::format;

struct SampleType {
    char kind;  ///< as in NumPy's dtype
    int bytes;
    const char* name;
    TypeDesc::BASETYPE type;
};

constexpr SampleType kSampleTypes[] = {
    { 'u', 1, "uint8", TypeDesc::UINT8 },   { 'u', 2, "uint16", TypeDesc::UINT16 },
    { 'u', 4, "uint32", TypeDesc::UINT32 }, { 'f', 2, "float16", TypeDesc::HALF },
    { 'f', 4, "float32", TypeDesc::FLOAT }, { 'f', 8, "float64", TypeDesc::DOUBLE },
};

std::string text(const py::handle& object)
{
    return py::str(object);
}

TypeDesc sample_type(const py::dtype& dtype)
{
    for (const SampleType& sample : kSampleTypes)
        if (dtype.kind() == sample.kind && dtype.itemsize() == sample.bytes)
            return sample.type;
    throw py::type_error(
        format("an array of {}: expected uint8, uint16, uint32, float16, float32 or float64", text(dtype)));
}

py::dtype numpy_type(const TypeDesc& type)
{
    for (const SampleType& sample : kSampleTypes)
        if (type == sample.type)
            return py::dtype(sample.name);
    return py::dtype("float32");
}

Picture from_array(const py::array& array)
{
    const TypeDesc type = sample_type(array.dtype());
    if ((array.ndim() != 2 && array.ndim() != 3) || array.size() == 0)
        throw py::value_error(
            format("an array of shape {}: expected (height, width) or (height, width, channels), none of them 0",
                   text(array.attr("shape"))));
    const py::array packed =
        py::module_::import("numpy").attr("ascontiguousarray")(array, array.dtype().attr("newbyteorder")("="));
    const int channels = array.ndim() == 3 ? int(array.shape(2)) : 1;
    ImageSpec spec(int(array.shape(1)), int(array.shape(0)), channels, type);
    if (channels == 2) {
        spec.channelnames = { "Y", "A" };
        spec.alpha_channel = 1;
    }
    return { std::make_shared<const ImageBuf>(spec, const_cast<void*>(packed.data())),
             { true, array.ndim() == 2 },
             packed };
}

bool has_methods(const py::object& object, std::initializer_list<const char*> names)
{
    return std::all_of(names.begin(), names.end(), [&](const char* name) { return py::hasattr(object, name); });
}

/// Attributes that say what the samples mean.
void copy_meaning(const py::object& from, ImageSpec& spec)
{
    const py::object space = from.attr("getattribute")("oiio:ColorSpace");
    if (py::isinstance<py::str>(space))
        spec.attribute("oiio:ColorSpace", text(space));
    const py::object chromaticities = from.attr("getattribute")("chromaticities");
    if (py::isinstance<py::sequence>(chromaticities) && py::len(chromaticities) == 8) {
        const auto values = chromaticities.cast<std::vector<float>>();
        spec.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), values.data());
    }
}

/// An ImageBuf of a module whose classes this one cannot share, such as OpenImageIO 3.2's, made with nanobind: its samples, names
/// of channels and what they mean. Results of it are arrays.
Picture from_foreign(const py::object& object)
{
    const py::object from = object.attr("spec")();
    const py::object samples = object.attr("get_pixels")(from.attr("format"));
    if (!py::isinstance<py::array>(samples))
        throw py::value_error("an ImageBuf without pixels");
    const Picture picture = from_array(samples.cast<py::array>());
    ImageSpec spec = picture.pixels->spec();
    const auto names = from.attr("channelnames").cast<std::vector<std::string>>();
    if (int(names.size()) == spec.nchannels)
        spec.channelnames = names;
    spec.alpha_channel = from.attr("alpha_channel").cast<int>();
    copy_meaning(from, spec);
    return { std::make_shared<const ImageBuf>(spec, const_cast<void*>(picture.pixels->localpixels())),
             { true, false },
             picture.owner };
}

}  // namespace

Picture to_picture(py::object object)
{
    if (py::isinstance(object, py::module_::import("numpy").attr("ma").attr("MaskedArray")))
        throw py::type_error("a masked array: expected one without a mask, such as its filled(0) or data");
    if (py::isinstance<py::array>(object))
        return from_array(py::reinterpret_borrow<py::array>(object));
    if (py::isinstance<ImageBuf>(object)) {
        const auto* pixels = object.cast<const ImageBuf*>();
        return { std::shared_ptr<const ImageBuf>(pixels, [](const ImageBuf*) {}), {}, std::move(object) };
    }
    const std::string type = text(py::type::of(object).attr("__name__"));
    if (type == "ImageBuf" && has_methods(object, { "spec", "get_pixels" }))
        return from_foreign(object);
    throw py::type_error(format("expected an OpenImageIO.ImageBuf, a NumPy array or a ProgressiveImage, not {}", type));
}

py::object to_python(ImageBuf result, Form form, int channels_of_source)
{
    if (!form.array) {
        if (py::detail::get_type_info(typeid(ImageBuf)) == nullptr)
            throw py::import_error("an ImageBuf needs Python's OpenImageIO: ask for arrays, array=True");
        return py::cast(std::move(result));
    }
    const ImageSpec& spec = result.spec();
    std::vector<py::ssize_t> shape { spec.height, spec.width };
    if (spec.nchannels > 1 || (!form.flat && channels_of_source == 1))
        shape.push_back(spec.nchannels);
    const py::dtype type = numpy_type(spec.format);
    py::array array(type, shape);
    if (!result.get_pixels(result.roi(), sample_type(type), array.mutable_data()))
        throw std::runtime_error(result.geterror());
    return py::object(std::move(array));
}

OIIO::ROI to_roi(const py::object& object)
{
    if (object.is_none())
        return {};
    if (py::isinstance<OIIO::ROI>(object))
        return object.cast<OIIO::ROI>();
    if (py::isinstance<py::sequence>(object) && py::len(object) == 4) {
        try {
            const auto roi = object.cast<std::vector<int>>();
            return { roi[0], roi[1], roi[2], roi[3] };
        } catch (const py::cast_error&) {
            // Not whole numbers of 32 bits: the message below says so, which that of the cast does not.
        }
    }
    if (has_methods(object, { "xbegin", "xend", "ybegin", "yend" })) {
        const auto number = [&](const char* name) {
            return object.attr(name).cast<int>();
        };
        return { number("xbegin"), number("xend"), number("ybegin"), number("yend") };
    }
    throw py::type_error("roi: expected an OpenImageIO.ROI or (xbegin, xend, ybegin, yend), whole numbers of 32 bits");
}

}  // namespace python
}  // namespace pimg
