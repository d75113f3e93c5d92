// SPDX-License-Identifier: BSD-3-Clause
// Small pictures made on the spot, by name, for the property tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace pimg::test {

struct Picture {
    std::string name;
    int width, height;
    std::vector<float> samples;
};

/// Deterministic noise in 0..1.
inline float noise(std::uint32_t x, std::uint32_t y, std::uint32_t seed = 1)
{
    std::uint32_t h = x * 374761393u + y * 668265263u + seed * 2246822519u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return float((h ^ (h >> 16)) & 0xffffff) / float(0xffffff);
}

template<class F>
Picture make(const std::string& name, int width, int height, F&& f)
{
    Picture p { name, width, height, {} };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            p.samples.push_back(float(f(x, y)));
    return p;
}

/// Shading, a disc, a bar and a little noise: edges at every angle, flat places, texture.
inline float scene(int x, int y, int width, int height)
{
    const float u = float(x) / float(width), v = float(y) / float(height);
    float value = 60.0f + 60.0f * u + 20.0f * v;
    const float r = std::hypot(u - 0.6f, v - 0.45f);
    if (r < 0.25f)
        value = 200.0f - 120.0f * r;
    if (std::fabs(u - 0.4f * v - 0.1f) < 0.03f)
        value = 20.0f;
    return std::nearbyint(value + 6.0f * noise(std::uint32_t(x), std::uint32_t(y)));
}

inline Picture scene(int width, int height)
{
    return make("scene", width, height, [=](int x, int y) { return scene(x, y, width, height); });
}

/// Pictures of every awkward size and content.
inline std::vector<Picture> awkward_pictures()
{
    std::vector<Picture> all;
    for (auto [w, h] : { std::pair { 1, 1 },
                         { 1, 7 },
                         { 9, 1 },
                         { 2, 2 },
                         { 2, 9 },
                         { 3, 3 },
                         { 5, 4 },
                         { 65, 3 },
                         { 33, 34 },
                         { 130, 70 } }) {
        const int width = w, height = h;
        all.push_back(make("scene " + std::to_string(w) + "x" + std::to_string(h), w, h,
                           [=](int x, int y) { return scene(x, y, width, height); }));
    }
    all.push_back(make("constant", 40, 30, [](int, int) { return 17.0f; }));
    all.push_back(make("zero", 40, 30, [](int, int) { return 0.0f; }));
    all.push_back(make("ramp", 40, 30, [](int x, int y) { return 3.0f * float(x) - float(y); }));
    all.push_back(make("step", 40, 30, [](int x, int) { return x < 20 ? 10.0f : 240.0f; }));
    all.push_back(make("checkerboard", 24, 24, [](int x, int y) { return (x + y) % 2 ? 255.0f : 0.0f; }));
    all.push_back(make("white pixel", 24, 24, [](int x, int y) { return x == 11 && y == 7 ? 255.0f : 0.0f; }));
    all.push_back(make("spike", 24, 24, [](int x, int y) { return x == 11 && y == 7 ? 1e6f : noise(x, y); }));
    all.push_back(make("noise", 64, 64, [](int x, int y) { return 255.0f * noise(x, y); }));
    return all;
}

}  // namespace pimg::test
