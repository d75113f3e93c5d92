// SPDX-License-Identifier: BSD-3-Clause
#include "pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>

namespace bench {

namespace {

/// Uniform in [0, 1), a pure function of the lattice point.
float hash(int x, int y, unsigned seed)
{
    std::uint32_t h = std::uint32_t(x) * 0x8da6b343u + std::uint32_t(y) * 0xd8163841u + seed * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return float((h ^ (h >> 15)) >> 8) / 16777216.0f;
}

/// Smoothly interpolated noise with one lattice point every `period` pixels.
float smooth_noise(int x, int y, int period, unsigned seed)
{
    const int i = x / period, j = y / period;
    const auto ease = [](float t) {
        return t * t * (3 - 2 * t);
    };
    const float s = ease(float(x % period) / float(period)), t = ease(float(y % period) / float(period));
    const float top = hash(i, j, seed) * (1 - s) + hash(i + 1, j, seed) * s;
    const float bottom = hash(i, j + 1, seed) * (1 - s) + hash(i + 1, j + 1, seed) * s;
    return top * (1 - t) + bottom * t;
}

/// Stops of light: hills of several sizes, sharp-edged patches, grain.
float landscape(int x, int y)
{
    float stops = -6;
    for (int period = 128, k = 0; period >= 4; period /= 2, ++k)
        stops += smooth_noise(x, y, period, unsigned(k)) * float(period) / 64.0f;
    const float patch = smooth_noise(x, y, 96, 20);
    stops += patch > 0.62f ? 7.0f : patch > 0.5f ? 2.5f : 0.0f;
    return stops + 0.15f * hash(x, y, 21);
}

OIIO::ImageBuf synthetic(int size)
{
    OIIO::ImageBuf buf(OIIO::ImageSpec(size, size, 3, OIIO::TypeDesc::FLOAT));
    for (OIIO::ImageBuf::Iterator<float> p(buf); !p.done(); ++p) {
        const float light = std::exp2(landscape(p.x(), p.y()));
        p[0] = light * (0.8f + 0.4f * smooth_noise(p.x(), p.y(), 48, 30));
        p[1] = light;
        p[2] = light * (0.8f + 0.4f * smooth_noise(p.x(), p.y(), 48, 31));
    }
    return buf;
}

OIIO::ImageBuf mirrored(const char* file, int size)
{
    OIIO::ImageBuf src(file);
    if (!src.read(0, 0, true, OIIO::TypeDesc::FLOAT) || src.nchannels() < 1) {
        std::fprintf(stderr, "PIMG_BENCH_PICTURE: %s\n", src.geterror().c_str());
        std::exit(1);
    }
    const auto fold = [](int i, int n) {
        return (i / n) % 2 ? n - 1 - i % n : i % n;
    };
    OIIO::ImageBuf buf(OIIO::ImageSpec(size, size, 3, OIIO::TypeDesc::FLOAT));
    for (OIIO::ImageBuf::Iterator<float> p(buf); !p.done(); ++p) {
        const int x = src.xbegin() + fold(p.x(), src.spec().width);
        const int y = src.ybegin() + fold(p.y(), src.spec().height);
        for (int c = 0; c < 3; ++c)
            p[c] = src.getchannel(x, y, 0, std::min(c, src.nchannels() - 1));
    }
    return buf;
}

}  // namespace

const OIIO::ImageBuf& picture(int size)
{
    static std::map<int, OIIO::ImageBuf> pictures;
    const auto found = pictures.find(size);
    if (found != pictures.end())
        return found->second;
    const char* file = std::getenv("PIMG_BENCH_PICTURE");
    return pictures[size] = file && *file ? mirrored(file, size) : synthetic(size);
}

const std::vector<float>& guide(int size)
{
    static std::map<int, std::vector<float>> guides;
    std::vector<float>& samples = guides[size];
    if (!samples.empty())
        return samples;
    const OIIO::ImageBuf& src = picture(size);
    for (OIIO::ImageBuf::ConstIterator<float> p(src); !p.done(); ++p)
        samples.push_back(std::log2(std::max(1e-6f, 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2])));
    const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
    const float offset = *low, scale = 255.0f / std::max(1e-6f, *high - *low);
    for (float& s : samples)
        s = (s - offset) * scale;
    return samples;
}

}  // namespace bench
