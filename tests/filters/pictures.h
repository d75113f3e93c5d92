// SPDX-License-Identifier: BSD-3-Clause
// Pictures for the filter tests.
#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <OpenImageIO/imagebuf.h>

#include <pimg/types.h>

#include "core/pictures.h"

namespace pimg::test {

/// Shown by every failed expectation on a bool from a filter.
#define EXPECT_FILTER(dst, call) EXPECT_TRUE(call) << (dst).geterror()

inline OIIO::ImageBuf picture(int width, int height, int channels, const OIIO::TypeDesc& type, int x0 = 0, int y0 = 0)
{
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.x = x0;
    spec.y = y0;
    spec.full_x = x0 - 3;
    spec.full_width = width + 7;
    return OIIO::ImageBuf(spec);
}

/// An HDR scene of about 14 stops: shade, a bright window with a soft edge, a lamp, texture; linear RGB.
inline OIIO::ImageBuf hdr_scene(int width = 96, int height = 64, const OIIO::TypeDesc& type = OIIO::TypeFloat,
                                int channels = 3, float scale = 1.0f)
{
    OIIO::ImageBuf buf = picture(width, height, channels, type, 5, -2);
    std::vector<float> pixel(std::size_t(channels), 0.25f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = float(x) / float(width), v = float(y) / float(height);
            float light = 0.05f * (1.0f + u);
            if (u > 0.35f && u < 0.7f && v > 0.2f && v < 0.7f)
                light = 40.0f * (1.0f - 0.5f * v);
            if (std::hypot(u - 0.15f, v - 0.3f) < 0.05f)
                light = 500.0f;
            light *= 1.0f + 0.1f * noise(std::uint32_t(x), std::uint32_t(y));
            const float colour[3] = { 1.0f, 0.8f - 0.3f * v, 0.6f + 0.3f * u };
            for (int c = 0; c < std::min(3, channels); ++c)
                pixel[std::size_t(c)] = scale * light * colour[c];
            buf.setpixel(x + buf.xbegin(), y + buf.ybegin(), pixel.data());
        }
    return buf;
}

/// A window of the picture that touches none of its sides.
inline OIIO::ROI window_of(const OIIO::ImageBuf& src)
{
    OIIO::ROI part = src.roi();
    part.xbegin += 11;
    part.xend -= 20;
    part.ybegin += 7;
    part.yend -= 3;
    return part;
}

inline std::vector<float> pixels(const OIIO::ImageBuf& buf, OIIO::ROI roi = {})
{
    const OIIO::ROI all = roi.defined() ? roi : buf.roi();
    std::vector<float> values(std::size_t(all.npixels()) * std::size_t(all.nchannels()));
    EXPECT_TRUE(buf.get_pixels(all, OIIO::TypeFloat, values.data()));
    return values;
}

/// The labels of a picture of them.
inline std::vector<Index> labels_of(const OIIO::ImageBuf& buf)
{
    EXPECT_FALSE(buf.has_error()) << buf.geterror();
    EXPECT_EQ(buf.spec().format, OIIO::TypeDesc(OIIO::TypeDesc::UINT32));
    EXPECT_EQ(buf.nchannels(), 1);
    std::vector<Index> labels(buf.spec().image_pixels());
    EXPECT_TRUE(buf.get_pixels(buf.roi(), OIIO::TypeDesc::UINT32, labels.data())) << buf.geterror();
    return labels;
}

inline float lstar(float y)
{
    y = std::max(y, 0.0f);
    return y > 0.008856f ? 116.0f * std::cbrt(y) - 16.0f : 903.3f * y;
}

/// L* of every pixel of a display-linear picture.
inline std::vector<float> lightness(const OIIO::ImageBuf& buf)
{
    const std::vector<float> p = pixels(buf);
    const std::size_t n = std::size_t(buf.nchannels());
    std::vector<float> l;
    for (std::size_t i = 0; i < p.size(); i += n)
        l.push_back(lstar(n < 3 ? p[i] : 0.2126f * p[i] + 0.7152f * p[i + 1] + 0.0722f * p[i + 2]));
    return l;
}

/// Bits equal, so that NaN equals itself.
inline bool identical(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace pimg::test
