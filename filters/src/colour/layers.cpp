// SPDX-License-Identifier: BSD-3-Clause
#include "colour/layers.h"

#include <algorithm>
#include <vector>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/detail/parts.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

namespace Strutil = OIIO::Strutil;

/// Channels whose names have the same words before the last dot.
struct Layer {
    std::string name;
    std::array<int, 3> rgb { -1, -1, -1 };
    int alpha = -1;
    std::vector<int> channels;

    bool complete() const { return std::min({ rgb[0], rgb[1], rgb[2] }) >= 0; }
};

std::string layer_of(const std::string& channel)
{
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot);
}

std::string last_word(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    return Strutil::lower(dot == std::string::npos ? name : name.substr(dot + 1));
}

/// 0 to 2 for red, green and blue, 3 for alpha, else -1.
int part_of(const std::string& word)
{
    static constexpr const char* kWords[][2] = { { "r", "red" }, { "g", "green" }, { "b", "blue" }, { "a", "alpha" } };
    for (int i = 0; i < 4; ++i)
        if (word == kWords[i][0] || word == kWords[i][1])
            return i;
    return -1;
}

bool is_data_word(const std::string& word)
{
    for (const char* beginning : { "crypto", "uvw", "index", "motion", "vector", "velocity", "normal", "depth" })
        if (Strutil::starts_with(word, beginning))
            return true;
    for (const char* data :
         { "z", "n", "p", "pos", "position", "uv", "u", "v", "st", "id", "ids", "speed", "zback", "mv" })
        if (word == data)
            return true;
    return Strutil::ends_with(word, "_id") || Strutil::ends_with(word, "id_") || Strutil::ends_with(word, "objectid")
        || Strutil::ends_with(word, "materialid") || Strutil::ends_with(word, "normals");
}

/// Words of layers that tell how much light surfaces or pixels let through, or where they are, not light: to multiply both
/// them and the light that they scale would count a factor twice.
bool is_surface_word(const std::string& word)
{
    for (const char* light : { "light", "painting" })
        if (Strutil::contains(word, light))
            return false;
    for (const char* part :
         { "albedo",      "occlusion",  "mask",    "matte",    "mist",      "roughness", "reflectance", "variance",
           "samplecount", "samplerate", "weight",  "coverage", "depth",     "normal",    "position",    "crypto",
           "texcoord",    "basecolor",  "opacity", "facing",   "wireframe", "filter",    "world",       "dpdt" })
        if (Strutil::contains(word, part))
            return true;
    for (const char* whole : { "ao", "alpha", "pref", "ng", "nn" })
        if (word == whole)
            return true;
    return Strutil::ends_with(word, "_ao") || (Strutil::ends_with(word, "col") && word.size() > 3);
}

bool is_data_layer(const std::string& name)
{
    const std::vector<std::string> words = Strutil::splits(Strutil::lower(name), ".");
    return std::any_of(words.begin(), words.end(), is_data_word);
}

std::vector<Layer> layers_of(const OIIO::ImageSpec& spec)
{
    std::vector<Layer> layers;
    for (int c = 0; c < spec.nchannels; ++c) {
        const std::string name = layer_of(spec.channel_name(c));
        auto layer = std::find_if(layers.begin(), layers.end(), [&](const Layer& l) { return l.name == name; });
        if (layer == layers.end())
            layer = layers.insert(layers.end(), Layer { name, { -1, -1, -1 }, -1, {} });
        const int part = part_of(last_word(spec.channel_name(c)));
        if (part == 3)
            layer->alpha = c;
        else if (part >= 0)
            layer->rgb[std::size_t(part)] = c;
        layer->channels.push_back(c);
    }
    return layers;
}

/// Red, green and blue of a layer, else its first channels that are neither alpha nor depth, else the first.
void take(const OIIO::ImageSpec& spec, const Layer& layer, PictureChannels& picture)
{
    picture = {};
    picture.alpha = layer.alpha;
    if (layer.name.empty() && picture.alpha < 0 && spec.alpha_channel >= 0
        && layer_of(spec.channel_name(spec.alpha_channel)).empty())
        picture.alpha = spec.alpha_channel;
    if (layer.complete()) {
        picture.channels = layer.rgb;
        picture.count = 3;
        return;
    }
    const auto add = [&](int c) {
        if (picture.count < 3)
            picture.channels[std::size_t(picture.count++)] = c;
    };
    for (const int c : layer.channels)
        if (c != picture.alpha && c != spec.alpha_channel && c != spec.z_channel)
            add(c);
    if (picture.count > 0)
        return;
    picture.alpha = -1;
    for (const int c : layer.channels)
        add(c);
}

std::string names_of(const std::vector<Layer>& layers)
{
    std::string names;
    for (const Layer& layer : layers)
        if (!layer.name.empty())
            names += (names.empty() ? "" : ", ") + layer.name;
    return names.empty() ? "none: the channels have no layers" : names;
}

bool find_named(const OIIO::ImageSpec& spec, const std::vector<Layer>& layers, const std::string& name,
                PictureChannels& picture)
{
    for (const bool whole : { true, false })
        for (const Layer& layer : layers)
            if (!layer.name.empty()
                && (whole ? Strutil::iequals(layer.name, name) : Strutil::iends_with(layer.name, "." + name))) {
                take(spec, layer, picture);
                return true;
            }
    for (int c = 0; c < spec.nchannels; ++c)
        if (Strutil::iequals(spec.channel_name(c), name)) {
            picture = {};
            picture.channels[0] = c;
            picture.count = 1;
            return true;
        }
    return false;
}

/// The layer that find_picture() chooses for ""; null if several may be meant.
const Layer* choose(const std::vector<Layer>& layers)
{
    std::vector<const Layer*> complete;
    const Layer* bare = nullptr;
    for (const Layer& layer : layers) {
        if (layer.name.empty())
            bare = &layer;
        if (layer.complete() && (layer.name.empty() || !is_data_layer(layer.name)))
            complete.push_back(&layer);
    }
    if (bare != nullptr && bare->complete())
        return bare;
    for (const char* usual : { "rgba", "color", "colour", "beauty", "combined", "c" })
        for (const Layer* layer : complete)
            if (last_word(layer->name) == usual)
                return layer;
    if (!complete.empty())
        return complete.size() == 1 ? complete[0] : nullptr;
    const auto is_alpha = [](const Layer& layer) {
        return int(layer.channels.size()) == (layer.alpha >= 0 ? 1 : 0);
    };
    if (bare != nullptr && !is_alpha(*bare))
        return bare;
    return layers.size() == 1 ? &layers[0] : nullptr;
}

}  // namespace

bool find_picture(const OIIO::ImageSpec& spec, const std::string& layer, PictureChannels& picture, std::string& error)
{
    const std::vector<Layer> layers = layers_of(spec);
    if (!layer.empty()) {
        if (find_named(spec, layers, layer, picture))
            return true;
        error = format("layer=\"{}\": expected one of {}", layer, names_of(layers));
        return false;
    }
    if (const Layer* chosen = choose(layers)) {
        take(spec, *chosen, picture);
        return true;
    }
    error = format("several layers may be the picture: expected layer=NAME (pimgtool: --layer NAME), one of {}",
                   names_of(layers));
    return false;
}

bool holds_data(const OIIO::ImageSpec& spec, int channel)
{
    const OIIO::TypeDesc type = spec.channelformat(channel);
    return type == OIIO::TypeDesc::UINT32 || type == OIIO::TypeDesc::INT32 || is_data_layer(spec.channel_name(channel));
}

bool holds_light(const OIIO::ImageSpec& spec, int channel)
{
    if (holds_data(spec, channel))
        return false;
    for (const Layer& layer : layers_of(spec))
        if (std::count(layer.rgb.begin(), layer.rgb.end(), channel) > 0) {
            const std::vector<std::string> words = Strutil::splits(Strutil::lower(layer.name), ".");
            return layer.complete() && std::none_of(words.begin(), words.end(), is_surface_word);
        }
    return false;
}

bool holds_picture(const OIIO::ImageSpec& part, const std::string& layer)
{
    if (part.deep || (layer.empty() && is_data_layer(part.get_string_attribute("oiio:subimagename"))))
        return false;
    PictureChannels picture;
    std::string error;
    if (!find_picture(part, layer, picture, error))
        return layer.empty();  // several layers may be the picture, so the user must name one
    const auto begin = picture.channels.begin();
    return std::any_of(begin, begin + picture.count, [&](int channel) { return !holds_data(part, channel); });
}

}  // namespace PIMG_ABI
}  // namespace pimg
