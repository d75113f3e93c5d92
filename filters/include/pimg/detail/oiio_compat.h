// SPDX-License-Identifier: BSD-3-Clause
// What differs between the versions of OpenImageIO that pimg is built with, 2.4 to 3.2, in one place (docs/hosts.md).
#pragma once

#include <initializer_list>
#include <memory>
#include <string>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/Imath.h>  // before texture.h, which otherwise declares a vector of its own
#include <OpenImageIO/texture.h>

#include <pimg/abi.h>

namespace pimg {
inline namespace PIMG_ABI {

/// ImageBufAlgo::resize() with the filter of that name, or OpenImageIO's choice for an empty one. 3.0 takes a list of
/// keywords in place of name and width.
inline bool resize_picture(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src, const std::string& filter, OIIO::ROI roi,
                           int nthreads)
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
    return OIIO::ImageBufAlgo::resize(dst, src, { { "filtername", filter } }, roi, nthreads);
#else
    return OIIO::ImageBufAlgo::resize(dst, src, filter, 0.0f, roi, nthreads);
#endif
}

/// An image cache of the caller's own. 3.0 counts references, and needs nobody to destroy it.
inline std::shared_ptr<OIIO::ImageCache> private_image_cache()
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
    return OIIO::ImageCache::create(false);
#else
    return { OIIO::ImageCache::create(false), [](OIIO::ImageCache* cache) {
                OIIO::ImageCache::destroy(cache);
            } };
#endif
}

/// The same for textures.
inline std::shared_ptr<OIIO::TextureSystem> private_texture_system()
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
    return OIIO::TextureSystem::create(false);
#else
    return { OIIO::TextureSystem::create(false), [](OIIO::TextureSystem* textures) {
                OIIO::TextureSystem::destroy(textures);
            } };
#endif
}

/// A picture whose pixels stay in a cache, which must outlive it.
inline OIIO::ImageBuf picture_in_cache(const std::string& filename, const std::shared_ptr<OIIO::ImageCache>& cache)
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
    return OIIO::ImageBuf(filename, 0, 0, cache);
#else
    return OIIO::ImageBuf(filename, 0, 0, cache.get());
#endif
}

/// Forgets what the shared image cache has read of a file.
inline void forget_in_shared_cache(const std::string& filename)
{
    const auto cache = OIIO::ImageCache::create(true);
    cache->invalidate(OIIO::ustring(filename), true);
}

/// Names and settings of a transform to a display.
struct DisplayTransform {
    std::string display, view, from, looks, context_key, context_value;
};

/// The processor of a transform to a display. 2.5 put a direction before the context: the call of 2.4 compiles there, and
/// takes one for the other.
inline OIIO::ColorProcessorHandle display_processor(const OIIO::ColorConfig& config, const DisplayTransform& t)
{
    using View = OIIO::string_view;
#if OIIO_VERSION >= OIIO_MAKE_VERSION(2, 5, 0)
    return config.createDisplayTransform(View(t.display), View(t.view), View(t.from), View(t.looks), false,
                                         View(t.context_key), View(t.context_value));
#else
    return config.createDisplayTransform(View(t.display), View(t.view), View(t.from), View(t.looks),
                                         View(t.context_key), View(t.context_value));
#endif
}

/// The view of a display that is meant when none is named. Since 3.1 it may depend on the space the picture is in.
inline std::string default_view(const OIIO::ColorConfig& config, const std::string& display, const std::string& from)
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 1, 0)
    const char* name = config.getDefaultViewName(display, from);
    if (name == nullptr || *name == '\0')  // rules for that space name none
        name = config.getDefaultViewName(display);
#else
    (void)from;
    const char* name = config.getDefaultViewName(display);
#endif
    return name == nullptr ? "" : name;
}

/// When $OCIO names no configuration, OpenImageIO 2.5 and newer fall back to one that OpenColorIO brings: the name it has
/// for a space, given by names for it, or `otherwise`, the name of OpenImageIO 2.4.
inline std::string space_without_config(const OIIO::ColorConfig& config, std::initializer_list<const char*> names,
                                        const char* otherwise)
{
#if OIIO_VERSION >= OIIO_MAKE_VERSION(2, 5, 0)
    for (const char* alias : names) {
        const std::string name(config.resolve(alias));
        if (config.getColorSpaceIndex(name) >= 0)
            return name;
    }
#else
    (void)config;
    (void)names;
#endif
    return otherwise;
}

/// So for linear light in Rec. 709, which filters take pictures to be in then; the role scene_linear may be another space.
inline std::string linear_rec709_without_config(const OIIO::ColorConfig& config)
{
    return space_without_config(config, { "lin_rec709_scene", "lin_rec709", "Linear Rec.709 (sRGB)" }, "linear");
}

/// So for sRGB.
inline std::string srgb_without_config(const OIIO::ColorConfig& config)
{
    return space_without_config(config, { "srgb_rec709_scene", "srgb_tx", "sRGB - Texture" }, "sRGB");
}

/// What linear light in Rec. 709 is called in metadata.
#if OIIO_VERSION >= OIIO_MAKE_VERSION(3, 1, 0)
constexpr const char* kDeclaredLinear = "lin_rec709_scene";
#elif OIIO_VERSION >= OIIO_MAKE_VERSION(3, 0, 0)
constexpr const char* kDeclaredLinear = "lin_rec709";
#else
constexpr const char* kDeclaredLinear = "Linear";
#endif

}  // namespace PIMG_ABI
}  // namespace pimg
