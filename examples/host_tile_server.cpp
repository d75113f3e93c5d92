// SPDX-License-Identifier: BSD-3-Clause
// A host that owns its pixels: float RGBA with rows that are longer than the picture. Windows of a frame are
// rendered into other memory of the host by several threads, from one hierarchy per frame that is kept as long as
// there is room. Every window is equal to its part of the whole frame; this program checks that.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <pimg/imagebufalgo.h>

namespace {

constexpr int kChannels = 4;

/// Memory of the host.
struct HostBuffer {
    HostBuffer(int its_width, int its_height, int padding)
        : width(its_width),
          height(its_height),
          row_floats(its_width * kChannels + padding),
          samples(std::size_t(row_floats) * std::size_t(its_height), -1.0f)
    {
    }
    float* pixel(int x, int y)
    {
        return &samples[std::size_t(y) * std::size_t(row_floats) + std::size_t(x * kChannels)];
    }
    std::ptrdiff_t row_bytes() const { return row_floats * std::ptrdiff_t(sizeof(float)); }

    int width, height, row_floats;
    std::vector<float> samples;
};

/// Host memory as OpenImageIO sees it, nothing copied; its upper left pixel is (x, y) of the frame.
OIIO::ImageBuf wrap(HostBuffer& buffer, int x, int y)
{
    OIIO::ImageSpec spec(buffer.width, buffer.height, kChannels, OIIO::TypeFloat);
    spec.x = x;
    spec.y = y;
    return OIIO::ImageBuf(spec, buffer.samples.data(), OIIO::AutoStride, buffer.row_bytes());
}

class TileServer {
public:
    explicit TileServer(std::size_t budget) : m_budget(budget) { }

    /// Renders the part of a frame that `window`, which lies at (x, y) of it, covers. May be called from many threads.
    bool render(int number, HostBuffer& frame, const pimg::HdrCompressOptions& options, HostBuffer& window, int x,
                int y, std::string& error)
    {
        const std::shared_ptr<const pimg::ProgressiveImage> image = image_of(number, frame);
        error = image->error();
        if (!image->initialized())
            return false;
        OIIO::ImageBuf dst = wrap(window, x, y);
        // One thread for each window: the host has threads of its own.
        if (!pimg::ImageBufAlgo::hdr_compress(dst, *image, options, dst.roi(), 1))
            error = dst.geterror();
        return error.empty();
    }

    int builds() const { return m_builds; }

private:
    struct Entry {
        int number;
        std::shared_ptr<const pimg::ProgressiveImage> image;
    };

    /// The frame used last is at the front; those at the back make room.
    std::shared_ptr<const pimg::ProgressiveImage> image_of(int number, HostBuffer& frame)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        for (auto entry = m_entries.begin(); entry != m_entries.end(); ++entry)
            if (entry->number == number) {
                m_entries.splice(m_entries.begin(), m_entries, entry);
                return entry->image;
            }
        auto image = std::make_shared<pimg::ProgressiveImage>();
        image->build(wrap(frame, 0, 0));
        ++m_builds;
        m_entries.push_front({ number, image });
        std::size_t bytes = 0;
        for (auto entry = m_entries.begin(); entry != m_entries.end();) {
            bytes += entry->image->initialized() ? entry->image->memory() : 0;
            const bool drop = bytes > m_budget && entry != m_entries.begin();
            entry = drop ? m_entries.erase(entry) : std::next(entry);
        }
        return image;
    }

    std::mutex m_mutex;
    std::list<Entry> m_entries;
    std::size_t m_budget;
    int m_builds = 0;
};

/// A room with a window: eight stops between the wall and the sky.
void draw(HostBuffer& frame, int number)
{
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            const bool sky = x > frame.width / 2 + 5 * number && y < frame.height / 2;
            const float grain = 0.9f + 0.2f * float((x * 7919 + y * 104729) % 101) / 101.0f;
            const float light = (sky ? 50.0f : 0.2f) * grain * (1.0f + float(y) / float(frame.height));
            const float rgba[kChannels] = { light, 0.9f * light, sky ? 1.3f * light : 0.6f * light, 1.0f };
            std::memcpy(frame.pixel(x, y), rgba, sizeof rgba);
        }
}

bool equal(HostBuffer& whole, HostBuffer& window, int x, int y)
{
    for (int row = 0; row < window.height && y + row < whole.height; ++row) {
        const int width = std::min(window.width, whole.width - x);
        if (std::memcmp(whole.pixel(x, y + row), window.pixel(0, row), std::size_t(width) * kChannels * sizeof(float))
            != 0)
            return false;
    }
    return true;
}

}  // namespace

int main()
{
    constexpr int kWidth = 400, kHeight = 300, kTile = 128, kFrames = 2;
    TileServer server(std::size_t(1) << 30);
    pimg::HdrCompressOptions options;
    options.beta = 4.0f;
    std::atomic<int> windows { 0 }, wrong { 0 };
    for (int number = 0; number < kFrames; ++number) {
        HostBuffer frame(kWidth, kHeight, 12), whole(kWidth, kHeight, 0);
        draw(frame, number);
        std::string error;
        if (!server.render(number, frame, options, whole, 0, 0, error)) {
            std::fprintf(stderr, "%s\n", error.c_str());
            return 1;
        }
        const auto serve = [&](int first_row) {
            for (int y = first_row; y < kHeight; y += 2 * kTile)
                for (int x = 0; x < kWidth; x += kTile) {
                    HostBuffer window(kTile, kTile, 4);
                    std::string problem;
                    ++windows;
                    if (!server.render(number, frame, options, window, x, y, problem) || !equal(whole, window, x, y))
                        ++wrong;
                }
        };
        std::thread other(serve, kTile);
        serve(0);
        other.join();
    }
    std::printf("%d windows of %d frames, %d differ from the whole frame, %d hierarchies built\n", windows.load(),
                kFrames, wrong.load(), server.builds());
    return wrong == 0 && server.builds() == kFrames ? 0 : 1;
}
