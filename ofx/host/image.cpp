// SPDX-License-Identifier: BSD-3-Clause
#include "host/image.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include <OpenImageIO/hash.h>
#include <OpenImageIO/imagebufalgo.h>

#include <pimg/labels.h>
#include <pimg/threads.h>

namespace pimg_ofx {

namespace {

using OIIO::TypeDesc;

int channels_of(const std::string& components)
{
    return components == kOfxImageComponentRGBA ? 4
        : components == kOfxImageComponentRGB   ? 3
        : components == kOfxImageComponentAlpha ? 1
                                                : 0;
}

/// Runs body(i) for every i below n by pool_loop(), which is empty for one thread.
void for_all(int threads, std::size_t n, const std::function<void(std::size_t)>& body)
{
    const pimg::ParallelFor loop = pimg::pool_loop(threads);
    if (loop)
        loop(n, body);
    else
        for (std::size_t i = 0; i < n; ++i)
            body(i);
}

OIIO::ImageSpec spec_of(const Image& image, const OfxRectI& box)
{
    OIIO::ImageSpec spec(box.x2 - box.x1, box.y2 - box.y1, image.channels(), image.depth());
    if (image.channels() == 1) {
        // Otherwise alpha would pass through filters untouched.
        spec.channelnames = { "Y" };
        spec.alpha_channel = -1;
    }
    return spec;
}

}  // namespace

OIIO::TypeDesc type_of_depth(const std::string& depth)
{
    return depth == kOfxBitDepthFloat ? TypeDesc::FLOAT
        : depth == kOfxBitDepthHalf   ? TypeDesc::HALF
        : depth == kOfxBitDepthShort  ? TypeDesc::UINT16
        : depth == kOfxBitDepthByte   ? TypeDesc::UINT8
                                      : TypeDesc::UNKNOWN;
}

bool operator==(const OfxRectI& a, const OfxRectI& b)
{
    return a.x1 == b.x1 && a.y1 == b.y1 && a.x2 == b.x2 && a.y2 == b.y2;
}

OfxRectI intersection(const OfxRectI& a, const OfxRectI& b)
{
    return { std::max(a.x1, b.x1), std::max(a.y1, b.y1), std::min(a.x2, b.x2), std::min(a.y2, b.y2) };
}

Image::Image(const Host& host, OfxImageClipHandle clip, OfxTime time, const OfxRectD* region) : m_host(host)
{
    if (clip == nullptr || host.effects().clipGetImage(clip, time, region, &m_handle) != kOfxStatOK) {
        m_handle = nullptr;
        return;
    }
    const Properties p = host.properties(m_handle);
    m_data = static_cast<char*>(p.pointer(kOfxImagePropData));
    m_bounds = p.rect(kOfxImagePropBounds);
    m_defined = p.rect(kOfxImagePropRegionOfDefinition);
    m_row_bytes = p.number(kOfxImagePropRowBytes);
    m_channels = channels_of(p.text(kOfxImageEffectPropComponents));
    m_depth = type_of_depth(p.text(kOfxImageEffectPropPixelDepth));
    m_premultiplication = p.text(kOfxImageEffectPropPreMultiplication);
    m_field = p.text(kOfxImagePropField, 0, kOfxImageFieldNone);
}

Image::~Image()
{
    if (m_handle != nullptr)
        m_host.effects().clipReleaseImage(m_handle);
}

OfxRectI Image::picture() const
{
    return is_empty(m_defined) ? m_bounds : intersection(m_bounds, m_defined);
}

OIIO::ImageBuf picture_of(const Image& image, int threads)
{
    const OfxRectI box = image.picture();
    const OIIO::ImageSpec spec = spec_of(image, box);
    OIIO::ImageBuf picture(spec);
    const std::size_t row_bytes = std::size_t(spec.width) * image.pixel_bytes();
    for_all(threads, std::size_t(spec.height), [&](std::size_t row) {
        const int y = int(row);
        std::memcpy(picture.pixeladdr(0, y), image.address(box.x1, box.y2 - 1 - y), row_bytes);
    });
    if (!image.is_unpremultiplied())
        return picture;
    OIIO::ImageBuf associated;
    pimg::run_without_foreign_tasks([&] {
        // Eight bits would not be enough to divide by a small alpha afterwards.
        const bool small = spec.format == TypeDesc::UINT8;
        if (small)
            associated.copy(picture, TypeDesc::UINT16);
        OIIO::ImageBufAlgo::premult(associated, small ? associated : picture);
    });
    return associated;
}

OIIO::ImageBuf canvas_of(const Image& output, const OfxRectI& picture)
{
    return OIIO::ImageBuf(spec_of(output, picture), output.address(picture.x1, picture.y2 - 1), OIIO::AutoStride,
                          -OIIO::stride_t(output.row_bytes()));
}

std::uint64_t fingerprint(const Image& image, int threads)
{
    const OfxRectI box = image.picture();
    const std::size_t row_bytes = std::size_t(box.x2 - box.x1) * image.pixel_bytes();
    std::vector<std::uint64_t> rows(std::size_t(box.y2 - box.y1));
    for_all(threads, rows.size(), [&](std::size_t row) {
        rows[row] = OIIO::farmhash::Hash64(image.address(box.x1, box.y2 - 1 - int(row)), row_bytes);
    });
    return OIIO::farmhash::Hash64(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof rows[0]);
}

namespace {

constexpr int kZero = -1, kOne = -2, kSourceAlpha = -3;

/// Where the samples of a channel of the output come from: a channel of the result, or one of the words above.
std::vector<int> sources_of(const OIIO::ImageBuf& result, const Image& source, const Image& output)
{
    const int channels = result.nchannels();
    std::vector<int> from(std::size_t(output.channels()), kZero);
    for (int c = 0; c < output.channels(); ++c) {
        int& place = from[std::size_t(c)];
        if (c == 3)
            place = channels == 4 ? 3 : source.has_alpha() ? kSourceAlpha : kOne;
        else if (output.channels() == 1)
            place = channels == 4 ? 3 : 0;
        else
            place = channels >= 3 ? c : 0;
    }
    return from;
}

/// Writes rows of one result.
class Writer {
public:
    Writer(const OIIO::ImageBuf& result, const Image& source, const Placement& placement, const Image& output)
        : m_result(result),
          m_source(source),
          m_placement(placement),
          m_output(output),
          m_inside(intersection(intersection(placement.window, placement.picture), output.bounds())),
          m_from(sources_of(result, source, output)),
          m_unpremultiplies(output.is_unpremultiplied() && placement.has_colours)
    {
        m_copies = result.spec().format == output.depth() && result.nchannels() == output.channels()
            && !m_unpremultiplies && !placement.is_labels;
    }

    void write(int y) const
    {
        const OfxRectI window = intersection(m_placement.window, m_output.bounds());
        const std::size_t bytes = m_output.pixel_bytes();
        if (y < m_inside.y1 || y >= m_inside.y2 || is_empty(m_inside)) {
            std::memset(m_output.address(window.x1, y), 0, std::size_t(window.x2 - window.x1) * bytes);
            return;
        }
        std::memset(m_output.address(window.x1, y), 0, std::size_t(m_inside.x1 - window.x1) * bytes);
        std::memset(m_output.address(m_inside.x2, y), 0, std::size_t(window.x2 - m_inside.x2) * bytes);
        const int x = m_inside.x1 - m_placement.picture.x1, row = m_placement.picture.y2 - 1 - y;
        if (m_copies)
            std::memcpy(m_output.address(m_inside.x1, y), m_result.pixeladdr(x, row), std::size_t(width()) * bytes);
        else
            convert(x, row, y);
    }

private:
    int width() const { return m_inside.x2 - m_inside.x1; }

    std::vector<float> floats(const void* pixels, const TypeDesc& type, int channels, OIIO::stride_t stride) const
    {
        std::vector<float> values(std::size_t(width()) * std::size_t(channels));
        OIIO::convert_image(channels, width(), 1, 1, pixels, type, stride, OIIO::AutoStride, OIIO::AutoStride,
                            values.data(), TypeDesc::FLOAT, OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride);
        return values;
    }

    void convert(int x, int row, int y) const
    {
        const std::vector<float> in =
            floats(m_result.pixeladdr(x, row), m_result.spec().format, m_result.nchannels(), m_result.pixel_stride());
        std::vector<float> alpha;
        if (std::find(m_from.begin(), m_from.end(), kSourceAlpha) != m_from.end())
            alpha = floats(m_source.address(m_inside.x1, y) + 3 * m_source.depth().size(), m_source.depth(), 1,
                           OIIO::stride_t(m_source.pixel_bytes()));
        // Labels stay the numbers they are; convert_image() would scale them to the range of the depth.
        const TypeDesc depth = m_output.depth();
        const float unit =
            m_placement.is_labels && !depth.is_floating_point() ? 1.0f / float(pimg::largest_label(depth)) : 1.0f;
        const std::size_t channels = m_from.size();
        std::vector<float> out(std::size_t(width()) * channels);
        for (std::size_t i = 0; i < std::size_t(width()); ++i) {
            float* pixel = &out[i * channels];
            for (std::size_t c = 0; c < channels; ++c)
                pixel[c] = m_from[c] >= 0 ? in[i * std::size_t(m_result.nchannels()) + std::size_t(m_from[c])] * unit
                    : m_from[c] == kOne   ? 1.0f
                    : m_from[c] == kZero  ? 0.0f
                                          : alpha[i];
            if (m_unpremultiplies && pixel[3] != 0.0f)
                for (std::size_t c = 0; c < 3; ++c)
                    pixel[c] /= pixel[3];
        }
        OIIO::convert_image(int(channels), width(), 1, 1, out.data(), TypeDesc::FLOAT, OIIO::AutoStride,
                            OIIO::AutoStride, OIIO::AutoStride, m_output.address(m_inside.x1, y), depth,
                            OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride);
    }

    const OIIO::ImageBuf& m_result;
    const Image& m_source;
    const Placement& m_placement;
    const Image& m_output;
    const OfxRectI m_inside;  ///< of the window, what is in the picture
    const std::vector<int> m_from;
    const bool m_unpremultiplies;
    bool m_copies;
};

}  // namespace

void write_result(const OIIO::ImageBuf& result, const Image& source, const Placement& placement, const Image& output,
                  int threads)
{
    const OfxRectI window = intersection(placement.window, output.bounds());
    if (is_empty(window))
        return;
    const Writer writer(result, source, placement, output);
    for_all(threads, std::size_t(window.y2 - window.y1), [&](std::size_t i) {
        const int y = window.y1 + int(i);
        if (((y - placement.first_row) % placement.row_step) == 0)
            writer.write(y);
    });
}

}  // namespace pimg_ofx
