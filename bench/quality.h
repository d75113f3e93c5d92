// SPDX-License-Identifier: BSD-3-Clause
// How well a simplified mesh, ours or a peer's, still shows the guide it was made from.
#pragma once

#include <array>
#include <vector>

#include <benchmark/benchmark.h>

namespace bench {

struct Vertex {
    double x, y, z;
};

/// Vertices kept, as shares of all, and the names of the counters that report them.
constexpr std::array<double, 4> kShares { 0.5, 0.1, 0.02, 0.005 };
constexpr std::array<const char*, 4> kShareNames { "psnr_50", "psnr_10", "psnr_2", "psnr_0.5" };

/// Sets the counters of one share: PSNR in dB, of 255, over the pixels that the triangles cover; and how many they do
/// not.
void report_quality(benchmark::State& state, std::size_t share, int size, const std::vector<Vertex>& vertices,
                    const std::vector<std::array<unsigned, 3>>& triangles);

}  // namespace bench
