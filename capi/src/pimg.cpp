// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/pimg.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include <pimg/detail/format.h>
#include <pimg/filter_table.h>
#include <pimg/version.h>

struct pimg_image {
    pimg::ProgressiveImage picture;
};

namespace {

using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::stride_t;
using pimg::format;

constexpr int kLargestSide = 1 << 20;  ///< of a .pimg file, too

void report(const char* message, char* error, std::size_t error_size)
{
    if (error == nullptr || error_size == 0)
        return;
    const std::size_t length = std::min(std::strlen(message), error_size - 1);
    std::memcpy(error, message, length);
    error[length] = '\0';
}

/// Runs `body(message)`; what it throws becomes a message, too.
template<class Body>
bool guarded(char* error, std::size_t error_size, Body&& body) noexcept
{
    try {
        std::string message;
        if (body(message))
            return true;
        report(pimg::one_line(message).c_str(), error, error_size);
    } catch (const std::bad_alloc&) {
        report("not enough memory", error, error_size);
    } catch (const std::exception& exception) {
        report(exception.what(), error, error_size);
    } catch (...) {
        report("an exception of unknown type", error, error_size);
    }
    return false;
}

bool check(const pimg_pixels* pixels, const char* name, std::string& error)
{
    const auto is_side = [](int side) {
        return side >= 1 && side <= kLargestSide;
    };
    if (pixels == nullptr || pixels->data == nullptr)
        error = format("{}: expected pixels", name);
    else if (!is_side(pixels->width) || !is_side(pixels->height))
        error =
            format("{}: {} x {} pixels: expected sides of 1 to {}", name, pixels->width, pixels->height, kLargestSide);
    else if (pixels->channels < 1 || pixels->channels > 1024)
        error = format("{}: {} channels: expected 1 to 1024", name, pixels->channels);
    else
        return true;
    return false;
}

/// The caller's memory as a picture whose upper left pixel is (x, y).
std::unique_ptr<ImageBuf> wrap(const pimg_pixels& pixels, int x, int y)
{
    ImageSpec spec(pixels.width, pixels.height, pixels.channels, OIIO::TypeFloat);
    spec.x = x;
    spec.y = y;
    const stride_t xstride = pixels.xstride != 0 ? pixels.xstride : stride_t(spec.pixel_bytes());
    const stride_t ystride = pixels.ystride != 0 ? pixels.ystride : xstride * pixels.width;
    return std::make_unique<ImageBuf>(spec, pixels.data, xstride, ystride);
}

}  // namespace

pimg_image* pimg_build(const pimg_pixels* picture, const char* options, char* error, size_t error_size)
{
    std::unique_ptr<pimg_image> image;
    const bool built = guarded(error, error_size, [&](std::string& message) {
        pimg::OptionTexts texts;
        pimg::BuildOptions build;
        if (!check(picture, "picture", message)
            || !pimg::split_options(options != nullptr ? options : "", texts, message)
            || !pimg::set_options(build, texts, message))
            return false;
        image = std::make_unique<pimg_image>();
        if (!image->picture.build(*wrap(*picture, 0, 0), build))
            message = image->picture.error();
        return message.empty();
    });
    return built ? image.release() : nullptr;
}

bool pimg_render(const pimg_image* image, const char* filter, const pimg_pixels* result, int x, int y, int nthreads,
                 char* error, size_t error_size)
{
    return guarded(error, error_size, [&](std::string& message) {
        if (image == nullptr || filter == nullptr) {
            message = image == nullptr ? "image: expected one" : "filter: expected a name";
            return false;
        }
        const std::string text = filter;
        const std::size_t colon = text.find(':');
        pimg::OptionTexts texts;
        pimg::BoundFilter run;
        const pimg::Filter* row = pimg::find_filter(text.substr(0, colon), message);
        if (row == nullptr || !check(result, "result", message)
            || !pimg::split_options(colon == text.npos ? "" : text.substr(colon + 1), texts, message)
            || !row->bind(texts, run, message))
            return false;
        // A window far away from the picture is allowed, and then nothing is written. But its edges must be numbers of
        // type int, and OpenImageIO takes INT_MIN for "everything".
        constexpr int kFar = 1 << 30;
        if (x < -kFar || x > kFar || y < -kFar || y > kFar) {
            message = format("x, y: {}, {}: expected a place within {} pixels of the origin", x, y, kFar);
            return false;
        }
        const std::unique_ptr<ImageBuf> window = wrap(*result, x, y);
        if (!run(*window, image->picture, window->roi(), nthreads))
            message = window->has_error() ? window->geterror() : "the filter failed";
        return message.empty();
    });
}

size_t pimg_memory(const pimg_image* image)
{
    return image != nullptr ? image->picture.memory() : 0;
}

void pimg_free(pimg_image* image)
{
    delete image;
}

const char* pimg_version(void)
{
    return PIMG_VERSION_STRING;
}
