// SPDX-License-Identifier: BSD-3-Clause
// What a user waits for: building a progressive image once, then each new setting. Arguments: size, threads. Wall time.
#include <benchmark/benchmark.h>

#include <pimg/imagebufalgo.h>

#include "pictures.h"

namespace {

void build_image(benchmark::State& state)
{
    const OIIO::ImageBuf& src = bench::picture(int(state.range(0)));
    for (auto _ : state) {
        pimg::ProgressiveImage image;
        if (!image.build(src, {}, int(state.range(1)))) {
            state.SkipWithError(image.error().c_str());
            return;
        }
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(src.spec().image_pixels()));
}
BENCHMARK(build_image)->ArgsProduct({ { 512, 1024 }, { 1, 2 } })->UseRealTime()->Unit(benchmark::kMillisecond);

void retune_hdr_compress(benchmark::State& state)
{
    const OIIO::ImageBuf& src = bench::picture(int(state.range(0)));
    pimg::ProgressiveImage image;
    if (!image.build(src, {}, int(state.range(1)))) {
        state.SkipWithError(image.error().c_str());
        return;
    }
    OIIO::ImageBuf dst;
    pimg::HdrCompressOptions options;
    for (int i = 0; i < 2; ++i)  // what later ones keep is made by the first two
        pimg::ImageBufAlgo::hdr_compress(dst, image, options, {}, int(state.range(1)));
    for (auto _ : state) {
        options.beta = options.beta == 1.0f ? 2.0f : 1.0f;
        if (!pimg::ImageBufAlgo::hdr_compress(dst, image, options, {}, int(state.range(1)))) {
            state.SkipWithError(dst.geterror().c_str());
            return;
        }
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(src.spec().image_pixels()));
}
BENCHMARK(retune_hdr_compress)->ArgsProduct({ { 512, 1024 }, { 1, 2 } })->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
