// SPDX-License-Identifier: BSD-3-Clause
// ImageSpec <-> PictureDesc.
//
// The type of an attribute is written as OpenImageIO prints it ("float", "int[3]", "matrix", "timecode", "string"), its
// value little-endian. One string is its bytes; each of an array of strings ends with a 0.
#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

#include <OpenImageIO/fmath.h>
#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "pimg_pvt.h"

namespace pimg {
namespace io {

namespace {

using OIIO::ImageSpec;
using OIIO::ParamValue;
using OIIO::TypeDesc;
using OIIO::ustring;

/// Attributes that say how a file is to be stored, or from which OpenImageIO's caches draw conclusions about its
/// pixels.
constexpr const char* kHints[] = { "compression",        "CompressionQuality", "textureformat", "planarconfig",
                                   "oiio:subimages",     "oiio:dither",        "oiio:ioproxy",  "oiio:SHA-1",
                                   "oiio:ConstantColor", "oiio:AverageColor" };

/// Beginnings of names of attributes that concern files of one format only. They could do harm: tiff:RowsPerStrip from
/// a hostile file would choose the size of OpenImageIO's buffers.
constexpr const char* kHintPrefixes[] = { "tiff:", "png:",    "jpeg:",    "jpeg2000:", "webp:", "heif:",
                                          "avif:", "jpegxl:", "openexr:", "bmp:",      "gif:",  "ico:",
                                          "sgi:",  "dds:",    "ptex:",    "maketx:" };

/// Attributes that say how this very file is to be written or was read, or that hold pointers.
bool is_hint(const std::string& name, const TypeDesc& type)
{
    if (type.basetype == TypeDesc::PTR || type.basetype == TypeDesc::UNKNOWN || type.basetype == TypeDesc::NONE)
        return true;
    if (OIIO::Strutil::istarts_with(name, "pimg:") || OIIO::Strutil::istarts_with(name, "thumbnail_"))
        return true;
    for (const char* hint : kHints)
        if (OIIO::Strutil::iequals(name, hint))
            return true;
    for (const char* prefix : kHintPrefixes)
        if (OIIO::Strutil::istarts_with(name, prefix))
            return true;
    return false;
}

/// Whether the value of an attribute that OpenImageIO's readers and writers rely on is a valid one.
bool is_sound(const std::string& name, TypeDesc type, const void* value)
{
    const auto within = [&](int low, int high) {
        int number = 0;
        if (type == TypeDesc::INT)
            std::memcpy(&number, value, sizeof number);
        return type == TypeDesc::INT && number >= low && number <= high;
    };
    if (OIIO::Strutil::iequals(name, "Orientation"))
        return within(1, 8);
    if (OIIO::Strutil::iequals(name, "oiio:BitsPerSample"))
        return within(1, 32);
    if (OIIO::Strutil::iequals(name, kUnassociatedAlpha))
        return within(0, 1);
    return true;
}

/// Attributes of our own, for what the names of the channels do not tell.
constexpr const char* kAlphaChannel = "pimg:alpha_channel";
constexpr const char* kDepthChannel = "pimg:z_channel";

/// How XMP says that a picture is a panorama.
constexpr const char* kProjection = "GPano:ProjectionType";

/// Whether OpenImageIO has a name for the type. If not, some versions abort when asked for it.
bool has_name(const TypeDesc& type)
{
    for (const TypeDesc& named : { OIIO::TypeTimeCode, OIIO::TypeKeyCode, OIIO::TypeRational })
        if (type == named)
            return true;
    return type.vecsemantics == TypeDesc::NOSEMANTICS
        || (type.aggregate == TypeDesc::VEC3 && type.vecsemantics <= TypeDesc::NORMAL);
}

/// The type as OpenImageIO prints it, if it can read that back; else "base:aggregate:semantics[length]".
std::string type_word(const TypeDesc& type)
{
    const std::string word = has_name(type) ? type.c_str() : "";
    if (!word.empty() && TypeDesc(word) == type)
        return word;
    return pimg::format("{}:{}:{}[{}]", TypeDesc(TypeDesc::BASETYPE(type.basetype)).c_str(), int(type.aggregate),
                        int(type.vecsemantics), type.arraylen);
}

TypeDesc parse_type(const std::string& word)
{
    const std::size_t colon = word.find(':');
    if (colon == std::string::npos)
        return TypeDesc(word);
    TypeDesc type(word.substr(0, colon));
    int aggregate = 0, semantics = 0, length = 0;
    if (std::sscanf(word.c_str() + colon, ":%d:%d[%d]", &aggregate, &semantics, &length) != 3 || aggregate < 1
        || aggregate > 16 || semantics < 0 || semantics > 255 || length < 0)
        return TypeDesc::UNKNOWN;
    return { TypeDesc::BASETYPE(type.basetype), TypeDesc::AGGREGATE(aggregate), TypeDesc::VECSEMANTICS(semantics),
             length };
}

/// Reverses the bytes of numbers on big-endian machines: files are little-endian.
void swap_on_big_endian(std::vector<std::uint8_t>& value, std::size_t size)
{
    if (OIIO::bigendian())
        for (std::size_t i = 0; i + size <= value.size(); i += size)
            std::reverse(value.begin() + std::ptrdiff_t(i), value.begin() + std::ptrdiff_t(i + size));
}

Attribute to_attribute(const ParamValue& param)
{
    TypeDesc type = param.type();
    if (param.nvalues() > 1)
        type.arraylen = int(type.numelements()) * param.nvalues();
    Attribute attribute { param.name().string(), type_word(type), {} };
    std::vector<std::uint8_t>& value = attribute.value;
    if (type.basetype == TypeDesc::STRING) {
        const auto* strings = static_cast<const char* const*>(param.data());
        const std::size_t count = type.numelements() * std::size_t(type.aggregate);
        for (std::size_t i = 0; i < count; ++i) {
            const char* text = strings[i] ? strings[i] : "";
            value.insert(value.end(), text, text + std::strlen(text) + (type.arraylen > 0 ? 1 : 0));
        }
    } else {
        const auto* bytes = static_cast<const std::uint8_t*>(param.data());
        value.assign(bytes, bytes + type.size());
        swap_on_big_endian(value, type.basesize());
    }
    return attribute;
}

/// The attributes of a header, by name. ImageSpec::attribute() looks through all of them each time, which would take
/// minutes for a file that has very many.
class AttributeList {
public:
    explicit AttributeList(ImageSpec& spec) : m_list(spec.extra_attribs) { }
    /// Of several attributes with the same name, ignoring case, the last one counts.
    void set(const std::string& name, const TypeDesc& type, const void* value)
    {
        const auto [found, is_new] = m_places.emplace(OIIO::Strutil::lower(name), m_list.size());
        if (is_new)
            m_list.emplace_back(name, type, 1, value);
        else
            m_list[int(found->second)] = ParamValue(name, type, 1, value);
    }

private:
    OIIO::ParamValueList& m_list;
    std::unordered_map<std::string, std::size_t> m_places;
};

void add_strings(AttributeList& list, const Attribute& attribute, const TypeDesc& type)
{
    const std::string text(attribute.value.begin(), attribute.value.end());
    if (type.arraylen == 0) {
        const ustring whole(text);
        list.set(attribute.name, TypeDesc::STRING, &whole);
        return;
    }
    std::vector<ustring> strings;
    for (std::size_t begin = 0, end; (end = text.find('\0', begin)) != std::string::npos; begin = end + 1)
        strings.emplace_back(text, begin, end - begin);
    if (strings.size() == type.numelements())
        list.set(attribute.name, type, strings.data());
}

/// Attributes of types unknown here are skipped: a later version of OpenImageIO may know them.
void add_attribute(AttributeList& list, const Attribute& attribute)
{
    const TypeDesc type = parse_type(attribute.type);
    // OpenImageIO ends a name at a zero character, so a name that holds one could be a hint without looking like one.
    if (attribute.name.empty() || attribute.name.find('\0') != std::string::npos || is_hint(attribute.name, type)
        || type.arraylen < 0)
        return;
    if (type.basetype == TypeDesc::STRING) {
        if (type.aggregate == TypeDesc::SCALAR)
            add_strings(list, attribute, type);
    } else if (type.size() == attribute.value.size()) {
        std::vector<std::uint8_t> value = attribute.value;
        swap_on_big_endian(value, type.basesize());
        if (is_sound(attribute.name, type, value.data()))
            list.set(attribute.name, type, value.data());
    }
}

int find_channel(const ImageSpec& spec, std::initializer_list<const char*> names)
{
    for (int c = 0; c < spec.nchannels; ++c)
        for (const char* name : names)
            if (OIIO::Strutil::iequals(spec.channel_name(c), name)
                || OIIO::Strutil::iends_with(spec.channel_name(c), std::string(".") + name))
                return c;
    return -1;
}

int alpha_by_name(const ImageSpec& spec)
{
    return find_channel(spec, { "A", "Alpha" });
}
int depth_by_name(const ImageSpec& spec)
{
    return find_channel(spec, { "Z", "Depth" });
}

Attribute channel_attribute(const char* name, int channel)
{
    return to_attribute(ParamValue(name, TypeDesc::INT, 1, &channel));
}

int channel_number(const Attribute& attribute, int channels)
{
    std::vector<std::uint8_t> value = attribute.value;
    swap_on_big_endian(value, 4);
    int channel = -1;
    if (value.size() == sizeof channel)
        std::memcpy(&channel, value.data(), sizeof channel);
    return channel < channels ? std::max(channel, -1) : -1;
}

/// The pixel types that files have; all others are stored as float.
constexpr std::pair<SampleType, TypeDesc::BASETYPE> kSampleTypes[] = {
    { SampleType::uint8, TypeDesc::UINT8 },   { SampleType::uint16, TypeDesc::UINT16 },
    { SampleType::uint32, TypeDesc::UINT32 }, { SampleType::half, TypeDesc::HALF },
    { SampleType::float32, TypeDesc::FLOAT },
};

SampleType sample_type(const TypeDesc& type)
{
    for (const auto& [sample, base] : kSampleTypes)
        if (base == type.basetype)
            return sample;
    return SampleType::float32;
}

}  // namespace

TypeDesc type_desc(SampleType type)
{
    for (const auto& [sample, base] : kSampleTypes)
        if (sample == type)
            return base;
    return TypeDesc::FLOAT;
}

TypeDesc stored_type(const TypeDesc& type)
{
    return type_desc(sample_type(type));
}

PictureDesc to_desc(const ImageSpec& spec)
{
    PictureDesc desc;
    desc.data = { spec.x, spec.y, std::uint32_t(spec.width), std::uint32_t(spec.height) };
    desc.display = { spec.full_x, spec.full_y, std::uint32_t(spec.full_width), std::uint32_t(spec.full_height) };
    if (spec.full_width < 1 || spec.full_height < 1)
        desc.display = desc.data;
    for (int c = 0; c < spec.nchannels; ++c)
        desc.channels.push_back({ spec.channel_name(c), sample_type(spec.channelformat(c)) });
    for (const ParamValue& param : spec.extra_attribs)
        if (!is_hint(param.name().string(), param.type()))
            desc.attributes.push_back(to_attribute(param));
    // What textureformat says of the picture, and not of the file that it came from.
    if (OIIO::Strutil::iequals(spec.get_string_attribute("textureformat"), "LatLong Environment")
        && spec.find_attribute(kProjection) == nullptr)
        desc.attributes.push_back(to_attribute(ParamValue(kProjection, "equirectangular")));
    if (spec.alpha_channel != alpha_by_name(spec))
        desc.attributes.push_back(channel_attribute(kAlphaChannel, spec.alpha_channel));
    if (spec.z_channel != depth_by_name(spec))
        desc.attributes.push_back(channel_attribute(kDepthChannel, spec.z_channel));
    return desc;
}

ImageSpec to_spec(const PictureDesc& desc)
{
    const int channels = int(desc.channels.size());
    ImageSpec spec(int(desc.data.width), int(desc.data.height), channels, type_desc(desc.channels[0].type));
    spec.x = desc.data.x;
    spec.y = desc.data.y;
    spec.full_x = desc.display.x;
    spec.full_y = desc.display.y;
    spec.full_width = int(desc.display.width);
    spec.full_height = int(desc.display.height);
    spec.channelnames.clear();
    for (const ChannelDesc& channel : desc.channels) {
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(type_desc(channel.type));
        // As everywhere in OpenImageIO, `format` is the most precise of the channels' formats.
        if (spec.channelformats.back().basetype > spec.format.basetype)
            spec.format = spec.channelformats.back();
    }
    if (std::count(spec.channelformats.begin(), spec.channelformats.end(), spec.format) == channels)
        spec.channelformats.clear();
    spec.alpha_channel = alpha_by_name(spec);
    spec.z_channel = depth_by_name(spec);
    AttributeList list(spec);
    for (const Attribute& attribute : desc.attributes) {
        if (attribute.name == kAlphaChannel)
            spec.alpha_channel = channel_number(attribute, channels);
        else if (attribute.name == kDepthChannel)
            spec.z_channel = channel_number(attribute, channels);
        else
            add_attribute(list, attribute);
    }
    return spec;
}

void add_hints(ImageSpec& spec, const WriteOptions& options)
{
    const WriteOptions defaults;
    for (const Option<WriteOptions>& option : option_table<WriteOptions>()) {
        const bool is_default = option.get(options) == option.get(defaults);
        if (is_default && describe_option(option.rule, option.get(defaults)).default_value.empty())
            continue;  // not set, which needs no hint
        const std::string name = std::string("pimg:") + option.rule.key;
        const auto add = [&](const auto& value) {
            spec.attribute(name, value);
        };
        std::visit(
            [&](const auto& value) {
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, bool>)
                    add(int(value));
                else
                    add(value);
            },
            option.get(options));
    }
}

std::string hint_text(const ParamValue& hint)
{
    // Not get_float(): OpenImageIO 2.4 returns its default for an int.
    switch (hint.type().basetype) {
    case TypeDesc::STRING:
        return hint.get_string();
    case TypeDesc::FLOAT:
        return pimg::format("{:.9g}", hint.get<float>());
    case TypeDesc::INT:
        return std::to_string(hint.get<int>());
    default:
        return hint.get_string();
    }
}

}  // namespace io

template<>
const std::vector<Option<io::WriteOptions>>& option_table<io::WriteOptions>()
{
    using W = io::WriteOptions;
    static const std::vector<Option<W>> table = {
        { &W::profile,
          { "profile", 0, 0, "", "compact|full", "full keeps the hierarchy, so that filters start at once" } },
        { &W::vertices, { "vertices", 0, 0.3, "of the pixels", "", "size of the mesh layer, the preview" } },
        { &W::effort, { "effort", 0, 2, "", "", "0 writes faster, 2 smaller" } },
        { &W::quality, { "quality", 0, 100, "percent", "", "the same as effort; samples are always exact" } },
        { &W::tile, { "tile", 16, 1024, "pixels", "", "side of the tiles the exact samples are coded in" } },
    };
    return table;
}

}  // namespace pimg
