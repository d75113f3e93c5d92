// SPDX-License-Identifier: BSD-3-Clause
// The engine alone: build, then synthesise, from plain floats.
#include <cmath>
#include <cstdio>
#include <vector>

#include <pimg/bands.h>
#include <pimg/simplify.h>
#include <pimg/version.h>

#if PIMG_VERSION < PIMG_MAKE_VERSION(0, 1, 0)
#error "version macros do not compare"
#endif

int main()
{
    const int width = 32, height = 24;
    std::vector<float> samples;
    for (int i = 0; i < width * height; ++i)
        samples.push_back(i % width < 11 ? 20.0f : 200.0f);

    pimg::Hierarchy hierarchy;
    std::vector<pimg::Bands> bands;
    const pimg::Guide guide { width, height, { { samples.data() } } };
    const pimg::Status status = pimg::simplify(guide, {}, hierarchy, bands);
    if (!status) {
        std::fprintf(stderr, "%s\n", status.error().c_str());
        return 1;
    }
    std::vector<float> result(samples.size());
    pimg::synthesise(hierarchy, bands[0], result.data());
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (std::abs(result[i] - samples[i]) > 1e-3f)
            return 1;
    std::puts(PIMG_VERSION_STRING);
    return 0;
}
