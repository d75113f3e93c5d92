// SPDX-License-Identifier: BSD-3-Clause
#include "frame/image_filter.h"

#include <algorithm>

#include <OpenImageIO/imagebufalgo_util.h>

#include <pimg/detail/format.h>

#include "frame/seam_mixer.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

bool is_empty(const OIIO::ROI& roi)
{
    return roi.xbegin >= roi.xend || roi.ybegin >= roi.yend || roi.zbegin >= roi.zend || roi.chbegin >= roi.chend;
}

bool is_built(OIIO::ImageBuf& dst, const ProgressiveImage& src, Previews previews)
{
    if (!src.initialized()) {
        set_error(dst, src.error().empty() ? "the progressive image has not been built" : src.error());
        return false;
    }
    if (src.data()->small != nullptr && previews == Previews::refused) {
        set_error(dst, "preview: expected hdr_compress; other filters need an image that was built without preview");
        return false;
    }
    return true;
}

/// Makes a destination of which every sample will be written. IBAprep would clear it, which takes as long as a third of a
/// filter; so it only says here, of one pixel, what metadata such a destination has.
bool allocate(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, const OIIO::ROI& roi, OIIO::ImageSpec spec)
{
    OIIO::ImageBuf pixel;
    OIIO::ROI one(roi.xbegin, roi.xbegin + 1, roi.ybegin, roi.ybegin + 1, roi.zbegin, roi.zbegin + 1, roi.chbegin,
                  roi.chend);
    if (!OIIO::ImageBufAlgo::IBAprep(one, &pixel, &data.source, nullptr, nullptr, &spec,
                                     OIIO::ImageBufAlgo::IBAprep_NO_SUPPORT_VOLUME)) {
        set_error(dst, pixel.geterror());
        return false;
    }
    OIIO::ImageSpec whole = pixel.spec();
    whole.x = roi.xbegin, whole.y = roi.ybegin;
    whole.width = roi.width(), whole.height = roi.height();
    dst.reset(whole, OIIO::InitializePixels::No);
    return true;
}

/// prepare() with the spec of a destination that does not exist yet.
bool prepare_as(OIIO::ImageBuf& dst, ProgressiveImage::Data& data, OIIO::ROI& roi, OIIO::ImageSpec spec)
{
    // A region with nothing of the source in it is no error, but IBAprep would turn it inside out.
    OIIO::ROI whole = OIIO::get_roi(data.picture);
    if (!roi.defined() && !dst.initialized())
        roi = whole;  // the source has margins, too
    if (roi.defined() && is_empty(OIIO::roi_intersection(roi, whole))) {
        roi = OIIO::ROI(whole.xbegin, whole.xbegin, whole.ybegin, whole.ybegin);
        return true;
    }
    spec.channelformats.clear();
    spec.tile_width = spec.tile_height = spec.tile_depth = 0;
    const bool all_written =
        OIIO::roi_intersection(roi, whole) == roi && roi.chbegin == 0 && roi.chend >= spec.nchannels;
    if (!dst.initialized() && all_written && !allocate(dst, data, roi, spec))
        return false;
    if (!OIIO::ImageBufAlgo::IBAprep(roi, &dst, &data.source, nullptr, nullptr, &spec,
                                     OIIO::ImageBufAlgo::IBAprep_NO_SUPPORT_VOLUME))
        return false;
    roi = OIIO::roi_intersection(roi, whole);
    roi.chend = std::min({ roi.chend, dst.nchannels(), data.source.nchannels() });
    return true;
}

}  // namespace

bool prepare(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI& roi, ResultType type, Previews previews)
{
    if (!is_built(dst, src, previews))
        return false;
    OIIO::ImageSpec spec = src.data()->picture;
    if (type == ResultType::full_float || (type == ResultType::floating && !spec.format.is_floating_point()))
        spec.format = OIIO::TypeDesc::FLOAT;
    return prepare_as(dst, *src.data(), roi, spec);
}

bool prepare_single(OIIO::ImageBuf& dst, const ProgressiveImage& src, OIIO::ROI& roi, const char* name,
                    const OIIO::TypeDesc& type, Previews previews)
{
    if (!is_built(dst, src, previews))
        return false;
    ProgressiveImage::Data& data = *src.data();
    OIIO::ImageSpec spec = data.picture;
    spec.nchannels = 1;
    spec.channelnames = { name };
    spec.alpha_channel = spec.z_channel = -1;
    if (type != OIIO::TypeDesc::UNKNOWN)
        spec.format = type;
    if (!roi.defined())
        roi = dst.initialized() ? dst.roi() : OIIO::get_roi(data.picture);
    roi.chbegin = 0;
    roi.chend = 1;
    return prepare_as(dst, data, roi, spec);
}

std::vector<float> alpha_of(const ProgressiveImage::Data& data)
{
    std::vector<float> alpha;
    const int channel = data.colour.alpha();
    if (channel < 0 || data.spec.get_int_attribute("oiio:UnassociatedAlpha") != 0)
        return alpha;
    const float* sample = static_cast<const float*>(data.source.localpixels()) + channel;
    for (std::size_t i = 0; i < data.spec.image_pixels(); ++i, sample += data.source.nchannels())
        alpha.push_back(std::clamp(*sample, 0.0f, 1.0f));
    return alpha;
}

PictureResult drawn_result(const ProgressiveImage::Data& data, Channels&& channels)
{
    // Colours of associated alpha are nothing where it is 0, so that neither paper nor joints show there.
    const std::vector<float> alpha = alpha_of(data);
    for (std::vector<float>& channel : channels) {
        crop_to_picture(data.hierarchy, channel);
        for (std::size_t i = 0; i < alpha.size(); ++i)
            channel[i] *= alpha[i];
    }
    return { std::move(channels), Specials::replaced, Seams::cut };
}

void write_rows(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, OIIO::ROI roi, const ParallelFor& parallel,
                const RowFilter& filter, Seams seams)
{
    if (is_empty(roi))
        return;
    const int channels = data.source.nchannels();
    const OIIO::TypeDesc type = dst.spec().format;
    const std::size_t pixel_bytes = std::size_t(channels) * sizeof(float);
    const bool in_place = type == OIIO::TypeDesc::FLOAT && roi.chbegin == 0 && roi.chend == channels
        && dst.pixel_stride() == OIIO::stride_t(pixel_bytes);
    const SeamMixer mixer(data, filter, seams == Seams::mixed);
    for_rows(parallel, roi.ybegin, roi.yend, [&](int y) {
        const RowSpan span { y, roi.xbegin, roi.xend };
        const float* source = static_cast<const float*>(data.source.pixeladdr(roi.xbegin, y, roi.zbegin));
        if (in_place) {
            float* row = static_cast<float*>(dst.pixeladdr(roi.xbegin, y, roi.zbegin));
            std::copy_n(source, std::size_t(roi.width()) * std::size_t(channels), row);
            mixer.make(span, row);
            return;
        }
        std::vector<float> row(source, source + std::size_t(roi.width()) * std::size_t(channels));
        mixer.make(span, row.data());
        OIIO::convert_image(roi.nchannels(), roi.width(), 1, 1, row.data() + roi.chbegin, OIIO::TypeDesc::FLOAT,
                            OIIO::stride_t(pixel_bytes), OIIO::AutoStride, OIIO::AutoStride,
                            dst.pixeladdr(roi.xbegin, y, roi.zbegin, roi.chbegin), type, dst.pixel_stride(),
                            OIIO::AutoStride, OIIO::AutoStride);
    });
}

void write_channels(OIIO::ImageBuf& dst, const ProgressiveImage::Data& data, OIIO::ROI roi, const ParallelFor& parallel,
                    const std::vector<std::vector<float>>& results, Specials specials, Seams seams)
{
    const OIIO::ImageSpec& spec = data.source.spec();
    const auto take = [&](const RowSpan& span, float* row) {
        const Index begin = Index(span.y - spec.y) * Index(spec.width) + Index(span.xbegin - spec.x);
        for (int i = 0; i < data.colour.count(); ++i) {
            float* out = row + data.colour.channel(i);
            const float* in = &results[std::size_t(i)][begin];
            for (std::size_t x = 0; x < span.width(); ++x, out += spec.nchannels)
                *out = in[x];
        }
        if (specials == Specials::replaced)
            return;
        for_specials(data, begin, span.width(),
                     [&](const SpecialSample& s) { row[int(s.pixel - begin) * spec.nchannels + s.channel] = s.value; });
    };
    write_rows(dst, data, roi, parallel, take, seams);
}

}  // namespace PIMG_ABI
}  // namespace pimg
