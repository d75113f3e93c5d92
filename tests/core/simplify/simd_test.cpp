// SPDX-License-Identifier: BSD-3-Clause
// Every instruction set this machine has must build the same hierarchy, bit for bit.
#include <cstring>

#include <gtest/gtest.h>

#include <pimg/simplify.h>

#include "core/pictures.h"
#include "core/simd_targets.h"

namespace pimg {
namespace {

template<class T>
std::size_t hash(const std::vector<T>& v, std::size_t h)
{
    const unsigned char* bytes = reinterpret_cast<const unsigned char*>(v.data());
    for (std::size_t i = 0; i < v.size() * sizeof(T); ++i)
        h = (h ^ bytes[i]) * 1099511628211ull;
    return h;
}

std::size_t hash_of(const test::Picture& p, std::size_t channels)
{
    Hierarchy h;
    std::vector<Bands> b;
    const GuideChannel channel { p.samples.data() };
    EXPECT_TRUE(simplify({ p.width, p.height, std::vector<GuideChannel>(channels, channel) }, {}, h, b).ok());
    return hash(b.back().details, hash(h.costs, hash(h.stencils, hash(h.splits, 14695981039346656037ull))));
}

TEST(Simd, EveryTargetGivesTheSameBits)
{
    const test::Picture pictures[] = { test::scene(170, 150), test::make("noise", 90, 90, [](int x, int y) {
                                           return 255 * test::noise(x, y);
                                       }) };
    std::size_t expected[2] = {};
    test::on_every_target([&](int tried, const char* target) {
        for (int i = 0; i < 2; ++i) {
            const std::size_t h = hash_of(pictures[i], std::size_t(i) + 1);
            if (tried == 0)
                expected[i] = h;
            EXPECT_EQ(h, expected[i]) << target << " " << pictures[i].name;
        }
    });
}

}  // namespace
}  // namespace pimg
