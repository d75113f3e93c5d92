// SPDX-License-Identifier: BSD-3-Clause
// Effects, clips and images of the test host.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include "parameter.h"
#include "property_set.h"

namespace test_host {

struct HostImage;

/// What a clip shows: pictures, one after the other, in the way the host wants to hand them out.
struct Footage {
    std::vector<OIIO::ImageBuf> frames;  ///< float, top row first, at full size
    double scale = 1.0;                  ///< of proxies
    int left = 0, bottom = 0;            ///< where the picture begins, in pixels of full size
    double aspect = 1.0;                 ///< width of a pixel over its height
    bool top_down = false;               ///< in memory
    bool without_end = false;            ///< the clip is defined everywhere; the picture is the project's window
    std::string components = kOfxImageComponentRGBA, depth = kOfxBitDepthFloat;
    std::string premultiplication = kOfxImagePreMultiplied, field = kOfxImageFieldNone;

    const OIIO::ImageBuf& at(OfxTime time) const;
    OfxRectI pixels(OfxTime time) const;  ///< at the scale
    OfxRectD region(OfxTime time) const;  ///< the same in canonical coordinates

    /// The frame as an image. It is made once, as a host has its images in memory.
    std::shared_ptr<HostImage> image(OfxTime time) const;

private:
    int index(OfxTime time) const;

    struct Images {
        std::mutex mutex;
        std::map<int, std::shared_ptr<HostImage>> made;
    };
    std::shared_ptr<Images> m_images = std::make_shared<Images>();
};

/// An image handed out. Rows are longer than their pixels, and nobody may write between them.
struct HostImage {
    PropertySet properties;
    std::vector<unsigned char> memory;
    OfxRectI bounds {};
    std::size_t row_bytes = 0, pixel_bytes = 0;
    bool top_down = false;

    HostImage(const Footage& footage, const OfxRectI& pixels, const OfxRectI& defined);
    unsigned char* address(int x, int y);
    bool is_intact() const;  ///< between the rows
};

/// Copies what has been rendered to its place.
void add_to_picture(HostImage& image, OIIO::ImageBuf& picture, const OfxRectI& whole);

struct Clip {
    std::string name;
    PropertySet properties;
    const Footage* footage = nullptr;  ///< null: not connected

    OfxImageClipHandle handle() { return reinterpret_cast<OfxImageClipHandle>(this); }
    static Clip& of(OfxImageClipHandle handle) { return *reinterpret_cast<Clip*>(handle); }
};

/// A descriptor or an instance.
struct Effect {
    PropertySet properties;
    ParameterSet parameters;
    std::map<std::string, Clip> clips;
    bool is_instance = false;
    std::atomic<long long> abort_at { 0 };  ///< nanoseconds of the steady clock; 0: never
    std::atomic<int> progress_open { 0 }, progress_calls { 0 };
    std::string message;  ///< the last one; read when no action runs
    std::mutex message_mutex;

    Effect();
    void make_instance_of(const Effect& descriptor, const std::string& context, const Footage* footage);

    OfxImageEffectHandle handle() { return reinterpret_cast<OfxImageEffectHandle>(this); }
    static Effect& of(OfxImageEffectHandle handle) { return *reinterpret_cast<Effect*>(handle); }
};

/// Images of source clips that have not been given back.
int count_images_out();

/// Whether the host has called the plug-in on this thread.
bool& is_in_action();

/// The image that the render action on this thread writes to.
HostImage*& output_of_this_thread();

const OfxImageEffectSuiteV1& effect_suite();

}  // namespace test_host
