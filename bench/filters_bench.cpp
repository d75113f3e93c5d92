// SPDX-License-Identifier: BSD-3-Clause
// What a user waits for: building a progressive image once, then each new setting. Arguments: size, threads. Wall time.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include <pimg/filter_table.h>

#include "pictures.h"

namespace {

pimg::ProgressiveImage built(int size, const pimg::BuildOptions& options, int threads, benchmark::State& state)
{
    pimg::ProgressiveImage image;
    if (!image.build(bench::picture(size), options, threads))
        state.SkipWithError(image.error().c_str());
    return image;
}

void build_image(benchmark::State& state, const char* mesh, bool preview)
{
    pimg::BuildOptions options;
    options.mesh = mesh;
    options.preview = preview;
    const int size = int(state.range(0));
    bench::picture(size);
    for (auto _ : state)
        if (!built(size, options, int(state.range(1)), state).initialized())
            return;
    state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
}
BENCHMARK_CAPTURE(build_image, auto, "auto", false) -> ArgsProduct({ { 512, 1024 }, { 1, 2 } }) -> UseRealTime()
    -> Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build_image, full, "full", false)
    ->ArgsProduct({ { 512, 1024 }, { 1, 2 } })
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build_image, preview, "auto", true)
    ->ArgsProduct({ { 512, 1024 }, { 1, 2 } })
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// Two settings of a filter, by turns. Options as on the command line.
void retune(benchmark::State& state, const char* name, const char* one, const char* other)
{
    const int size = int(state.range(0)), threads = int(state.range(1));
    const pimg::ProgressiveImage image = built(size, {}, threads, state);
    if (!image.initialized())
        return;
    std::string error;
    const pimg::Filter* filter = pimg::find_filter(name, error);
    pimg::BoundFilter settings[2];
    for (int i = 0; i < 2; ++i) {
        pimg::OptionTexts texts;
        if (filter == nullptr || !pimg::split_options(i == 0 ? one : other, texts, error)
            || !filter->bind(texts, settings[i], error)) {
            state.SkipWithError(error.c_str());
            return;
        }
    }
    OIIO::ImageBuf dst;
    const auto run = [&](int turn) {
        if (settings[turn % 2](dst, image, {}, threads))
            return true;
        state.SkipWithError(dst.geterror().c_str());
        return false;
    };
    for (int turn = 0; turn < 2; ++turn)  // what later ones keep is made by the first two
        if (!run(turn))
            return;
    int turn = 0;
    for (auto _ : state)
        if (!run(turn++))
            return;
    state.SetItemsProcessed(state.iterations() * std::int64_t(size) * size);
}

#define PIMG_RETUNE(title, ...)                                                                                        \
    BENCHMARK_CAPTURE(retune, title, __VA_ARGS__)                                                                      \
        ->ArgsProduct({ { 1024 }, { 1, 2 } })                                                                          \
        ->UseRealTime()                                                                                                \
        ->Unit(benchmark::kMillisecond)
PIMG_RETUNE(hdr_compress, "hdr_compress", "beta=1", "beta=2")->Args({ 512, 2 })->Args({ 2880, 2 });
PIMG_RETUNE(lowpass_strength, "feature_lowpass", "strength=0.3", "strength=0.4");
PIMG_RETUNE(lowpass_fraction, "feature_lowpass", "fraction=0.1", "fraction=0.2");
PIMG_RETUNE(enhance_gain, "detail_enhance", "gain=2", "gain=3");
PIMG_RETUNE(enhance_strength, "detail_enhance", "strength=0.3:gain=2", "strength=0.3:gain=3");
PIMG_RETUNE(level, "level", "fraction=0.02", "fraction=0.04");
PIMG_RETUNE(segment, "segment", "regions=500", "regions=600");
#undef PIMG_RETUNE

}  // namespace
