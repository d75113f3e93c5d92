// SPDX-License-Identifier: BSD-3-Clause
#include "effect.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstring>

#include <OpenImageIO/imagebufalgo.h>

namespace test_host {

namespace {

using OIIO::TypeDesc;
using Text = std::string;

std::atomic<int> images_out { 0 };

constexpr unsigned char kUntouched = 0xa5;
constexpr std::size_t kPadding = 24;  ///< bytes after each row of pixels; not a multiple of the size of large pixels

TypeDesc type_of(const std::string& depth)
{
    return depth == kOfxBitDepthByte ? TypeDesc::UINT8
        : depth == kOfxBitDepthShort ? TypeDesc::UINT16
        : depth == kOfxBitDepthHalf  ? TypeDesc::HALF
                                     : TypeDesc::FLOAT;
}

int channels_of(const std::string& components)
{
    return components == kOfxImageComponentRGBA ? 4 : components == kOfxImageComponentRGB ? 3 : 1;
}

std::vector<Value> four(const OfxRectI& r)
{
    return { r.x1, r.y1, r.x2, r.y2 };
}

void define_clip(Clip& clip)
{
    PropertySet& set = clip.properties;
    set.define(kOfxPropType, 1, { Text(kOfxTypeClip) }).define(kOfxPropName, 1, { clip.name });
    for (const char* label : { kOfxPropLabel, kOfxPropShortLabel, kOfxPropLongLabel })
        set.define(label, 1, { clip.name });
    set.define_list(kOfxImageEffectPropSupportedComponents, Text());
    for (const char* name :
         { kOfxImageEffectPropTemporalClipAccess, kOfxImageClipPropOptional, kOfxImageClipPropIsMask })
        set.define(name, 1, { 0 });
    set.define(kOfxImageEffectPropSupportsTiles, 1, { 1 });
    set.define(kOfxImageClipPropFieldExtraction, 1, { Text(kOfxImageFieldDoubled) });
}

/// What an instance's clip has besides.
void connect(Clip& clip, const Footage* footage)
{
    clip.footage = footage;
    PropertySet& set = clip.properties;
    const Footage none;
    const Footage& f = footage != nullptr ? *footage : none;
    set.define(kOfxImageClipPropConnected, 1, { footage != nullptr ? 1 : 0 });
    set.define(kOfxImageEffectPropComponents, 1, { footage != nullptr ? f.components : Text(kOfxImageComponentNone) });
    set.define(kOfxImageEffectPropPixelDepth, 1, { f.depth });
    set.define(kOfxImageEffectPropPreMultiplication, 1, { f.premultiplication });
    set.define(kOfxImagePropPixelAspectRatio, 1, { f.aspect }).define(kOfxImageEffectPropFrameRate, 1, { 24.0 });
    set.define(kOfxImageEffectPropFrameRange, 2, { 1.0, double(f.frames.size()) });
    set.define(kOfxImageClipPropFieldOrder, 1, { f.field }).define(kOfxImageClipPropContinuousSamples, 1, { 0 });
    set.define(kOfxImageClipPropColourspace, 1, { Text() });
}

}  // namespace

int Footage::index(OfxTime time) const
{
    return std::clamp(int(std::lround(time)) - 1, 0, int(frames.size()) - 1);
}

const OIIO::ImageBuf& Footage::at(OfxTime time) const
{
    return frames[std::size_t(index(time))];
}

OfxRectI Footage::pixels(OfxTime time) const
{
    const OIIO::ImageSpec& spec = at(time).spec();
    const auto scaled = [&](int x) {
        return int(std::lround(x * scale));
    };
    return { scaled(left), scaled(bottom), scaled(left) + scaled(spec.width), scaled(bottom) + scaled(spec.height) };
}

OfxRectD Footage::region(OfxTime time) const
{
    const OIIO::ImageSpec& spec = at(time).spec();
    return { left * aspect, double(bottom), (left + spec.width) * aspect, double(bottom + spec.height) };
}

HostImage::HostImage(const Footage& footage, const OfxRectI& pixels, const OfxRectI& defined)
    : bounds(pixels),
      top_down(footage.top_down)
{
    pixel_bytes = std::size_t(channels_of(footage.components)) * type_of(footage.depth).size();
    row_bytes = std::size_t(pixels.x2 - pixels.x1) * pixel_bytes + kPadding;
    memory.assign(row_bytes * std::size_t(pixels.y2 - pixels.y1), kUntouched);
    properties.define(kOfxPropType, 1, { Text(kOfxTypeImage) });
    properties.define(kOfxImagePropData, 1, { static_cast<void*>(address(pixels.x1, pixels.y1)) });
    properties.define(kOfxImagePropBounds, 4, four(pixels)).define(kOfxImagePropRegionOfDefinition, 4, four(defined));
    properties.define(kOfxImagePropRowBytes, 1, { top_down ? -int(row_bytes) : int(row_bytes) });
    properties.define(kOfxImageEffectPropComponents, 1, { footage.components });
    properties.define(kOfxImageEffectPropPixelDepth, 1, { footage.depth });
    properties.define(kOfxImageEffectPropPreMultiplication, 1, { footage.premultiplication });
    properties.define(kOfxImageEffectPropRenderScale, 2, { footage.scale, footage.scale });
    properties.define(kOfxImagePropPixelAspectRatio, 1, { footage.aspect });
    properties.define(kOfxImagePropField, 1, { footage.field });
    properties.define(kOfxImagePropUniqueIdentifier, 1, { Text() });
}

unsigned char* HostImage::address(int x, int y)
{
    const int row = top_down ? bounds.y2 - 1 - y : y - bounds.y1;
    return memory.data() + std::size_t(row) * row_bytes + std::size_t(x - bounds.x1) * pixel_bytes;
}

bool HostImage::is_intact() const
{
    for (std::size_t end = row_bytes; end <= memory.size(); end += row_bytes)
        for (std::size_t i = end - kPadding; i < end; ++i)
            if (memory[i] != kUntouched)
                return false;
    return true;
}

namespace {

OIIO::ImageBuf scaled_to(const OIIO::ImageBuf& frame, OIIO::ROI size)
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
    return OIIO::ImageBufAlgo::resize(frame, { { "filtername", "box" } }, size);
#else
    return OIIO::ImageBufAlgo::resize(frame, "box", 0.0f, size);
#endif
}

std::shared_ptr<HostImage> image_of(const Footage& footage, OfxTime time)
{
    const OfxRectI box = footage.pixels(time);
    OIIO::ImageBuf scaled = footage.at(time);
    if (footage.scale != 1.0)
        scaled = scaled_to(scaled, OIIO::ROI(0, box.x2 - box.x1, 0, box.y2 - box.y1));
    const int channels = channels_of(footage.components);
    if (channels != scaled.nchannels()) {
        std::vector<int> order;
        std::vector<float> values;
        for (int c = 0; c < channels; ++c) {
            order.push_back(c < scaled.nchannels() ? c : -1);
            values.push_back(1.0f);
        }
        scaled = OIIO::ImageBufAlgo::channels(scaled, channels, order, values);
    }
    const OfxRectI everywhere { INT_MIN, INT_MIN, INT_MAX, INT_MAX };
    auto image = std::make_shared<HostImage>(footage, box, footage.without_end ? everywhere : box);
    for (int y = box.y1; y < box.y2; ++y) {
        const int row = box.y2 - 1 - y;
        scaled.get_pixels(OIIO::ROI(0, box.x2 - box.x1, row, row + 1, 0, 1, 0, channels), type_of(footage.depth),
                          image->address(box.x1, y));
    }
    return image;
}

}  // namespace

std::shared_ptr<HostImage> Footage::image(OfxTime time) const
{
    const std::lock_guard<std::mutex> lock(m_images->mutex);
    std::shared_ptr<HostImage>& place = m_images->made[index(time)];
    if (place == nullptr)
        place = image_of(*this, time);
    return place;
}

void add_to_picture(HostImage& image, OIIO::ImageBuf& picture, const OfxRectI& whole)
{
    const OfxRectI& b = image.bounds;
    const int channels = picture.nchannels();
    const TypeDesc type = type_of(image.properties.text(kOfxImageEffectPropPixelDepth));
    for (int y = b.y1; y < b.y2; ++y) {
        const int row = whole.y2 - 1 - y, x = b.x1 - whole.x1;
        picture.set_pixels(OIIO::ROI(x, x + b.x2 - b.x1, row, row + 1, 0, 1, 0, channels), type,
                           image.address(b.x1, y));
    }
}

int count_images_out()
{
    return images_out;
}

bool& is_in_action()
{
    thread_local bool within = false;
    return within;
}

HostImage*& output_of_this_thread()
{
    thread_local HostImage* image = nullptr;
    return image;
}

Effect::Effect()
{
    PropertySet& set = properties;
    set.define(kOfxPropType, 1, { Text(kOfxTypeImageEffect) });
    for (const char* label : { kOfxPropLabel, kOfxPropShortLabel, kOfxPropLongLabel, kOfxPropVersionLabel,
                               kOfxPropPluginDescription, kOfxImageEffectPluginPropGrouping, kOfxPluginPropFilePath })
        set.define(label, 1, { Text() });
    for (const char* list : { kOfxImageEffectPropSupportedContexts, kOfxImageEffectPropSupportedPixelDepths,
                              kOfxImageEffectPropColourManagementAvailableConfigs })
        set.define_list(list, Text());
    for (const char* flag :
         { kOfxImageEffectPluginPropSingleInstance, kOfxImageEffectPluginPropHostFrameThreading,
           kOfxImageEffectPropSupportsMultiResolution, kOfxImageEffectPropSupportsTiles,
           kOfxImageEffectPropTemporalClipAccess, kOfxImageEffectPropSupportsMultipleClipDepths,
           kOfxImageEffectPropSupportsMultipleClipPARs, kOfxImageEffectPluginPropFieldRenderTwiceAlways })
        set.define(flag, 1, { 0 });
    set.define(kOfxImageEffectPluginRenderThreadSafety, 1, { Text() });
    set.define(kOfxImageEffectPropColourManagementStyle, 1, { Text(kOfxImageEffectColourManagementNone) });
    set.define(kOfxImageEffectPropOCIOConfig, 1, { Text() });
}

void Effect::make_instance_of(const Effect& descriptor, const std::string& context, const Footage* footage)
{
    is_instance = true;
    properties = descriptor.properties;
    properties.define(kOfxPropType, 1, { Text(kOfxTypeImageEffectInstance) });
    properties.define(kOfxImageEffectPropContext, 1, { context });
    properties.define(kOfxPropInstanceData, 1, { static_cast<void*>(nullptr) });
    const OfxRectD window = footage != nullptr ? footage->region(1.0) : OfxRectD {};
    properties.define(kOfxImageEffectPropProjectOffset, 2, { window.x1, window.y1 });
    properties.define(kOfxImageEffectPropProjectSize, 2, { window.x2 - window.x1, window.y2 - window.y1 });
    parameters.copy_from(descriptor.parameters);
    clips = descriptor.clips;
    for (auto& [name, clip] : clips)
        connect(clip, footage);
}

namespace {

OfxStatus clip_define(OfxImageEffectHandle handle, const char* name, OfxPropertySetHandle* properties)
{
    Clip& clip = Effect::of(handle).clips[name];
    clip.name = name;
    define_clip(clip);
    *properties = clip.properties.handle();
    return kOfxStatOK;
}

OfxStatus clip_get_handle(OfxImageEffectHandle handle, const char* name, OfxImageClipHandle* clip,
                          OfxPropertySetHandle* properties)
{
    auto& clips = Effect::of(handle).clips;
    const auto found = clips.find(name);
    if (found == clips.end())
        return kOfxStatErrUnknown;
    *clip = found->second.handle();
    if (properties != nullptr)
        *properties = found->second.properties.handle();
    return kOfxStatOK;
}

/// What a plug-in holds of an image of a source.
struct ImageInUse {
    PropertySet properties;  ///< first: its address is the handle
    std::shared_ptr<HostImage> image;
};

OfxStatus get_image(OfxImageClipHandle handle, OfxTime time, const OfxRectD*, OfxPropertySetHandle* image)
{
    Clip& clip = Clip::of(handle);
    if (clip.footage == nullptr)
        return kOfxStatFailed;
    if (clip.name == kOfxImageEffectOutputClipName) {
        HostImage* output = output_of_this_thread();
        if (output == nullptr) {
            violation("the output is asked for outside of render");
            return kOfxStatFailed;
        }
        *image = output->properties.handle();
        return kOfxStatOK;
    }
    ++images_out;
    const std::shared_ptr<HostImage> made = clip.footage->image(time);
    *image = (new ImageInUse { made->properties, made })->properties.handle();
    return kOfxStatOK;
}

OfxStatus release_image(OfxPropertySetHandle image)
{
    // The properties of an output are the host's own.
    HostImage* output = output_of_this_thread();
    if (output != nullptr && image == output->properties.handle())
        return kOfxStatOK;
    --images_out;
    delete reinterpret_cast<ImageInUse*>(image);
    return kOfxStatOK;
}

OfxStatus region_of_definition(OfxImageClipHandle handle, OfxTime time, OfxRectD* bounds)
{
    const Clip& clip = Clip::of(handle);
    if (clip.footage == nullptr)
        return kOfxStatFailed;
    *bounds = clip.footage->region(time);
    if (clip.footage->without_end)
        *bounds = { double(INT_MIN), double(INT_MIN), double(INT_MAX), double(INT_MAX) };
    return kOfxStatOK;
}

int is_aborted(OfxImageEffectHandle handle)
{
    if (!is_in_action())
        violation("a thread that the host has not called asks whether to stop");
    const long long at = Effect::of(handle).abort_at;
    return at != 0 && std::chrono::steady_clock::now().time_since_epoch().count() >= at ? 1 : 0;
}

}  // namespace

const OfxImageEffectSuiteV1& effect_suite()
{
    static const OfxImageEffectSuiteV1 suite = {
        [](OfxImageEffectHandle handle, OfxPropertySetHandle* properties) -> OfxStatus {
            *properties = Effect::of(handle).properties.handle();
            return kOfxStatOK;
        },
        [](OfxImageEffectHandle handle, OfxParamSetHandle* parameters) -> OfxStatus {
            *parameters = Effect::of(handle).parameters.handle();
            return kOfxStatOK;
        },
        clip_define,
        clip_get_handle,
        [](OfxImageClipHandle handle, OfxPropertySetHandle* properties) -> OfxStatus {
            *properties = Clip::of(handle).properties.handle();
            return kOfxStatOK;
        },
        get_image,
        release_image,
        region_of_definition,
        is_aborted,
        [](OfxImageEffectHandle, size_t, OfxImageMemoryHandle*) -> OfxStatus { return kOfxStatErrUnsupported; },
        [](OfxImageMemoryHandle) -> OfxStatus { return kOfxStatErrUnsupported; },
        [](OfxImageMemoryHandle, void**) -> OfxStatus { return kOfxStatErrUnsupported; },
        [](OfxImageMemoryHandle) -> OfxStatus { return kOfxStatErrUnsupported; },
    };
    return suite;
}

}  // namespace test_host
