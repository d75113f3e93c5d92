// SPDX-License-Identifier: BSD-3-Clause
// The codec's decoder behind OpenImageIO's IOProxy, and the hierarchy in a file.
#include <algorithm>

#include "pimg_pvt.h"

namespace pimg {
namespace io {

namespace {

class ProxySource final : public Source {
public:
    explicit ProxySource(OIIO::Filesystem::IOProxy* proxy) : m_proxy(proxy), m_size(proxy->size()) { }
    std::uint64_t size() const override { return m_size; }
    bool read(std::uint64_t offset, std::size_t count, void* to) const override
    {
        for (auto* bytes = static_cast<char*>(to); count > 0;) {
            const std::size_t n = m_proxy->pread(bytes, count, std::int64_t(offset));
            if (n == 0 || n > count)
                return false;
            bytes += n, offset += n, count -= n;
        }
        return true;
    }

private:
    OIIO::Filesystem::IOProxy* m_proxy;
    std::uint64_t m_size;
};

/// Whether the samples lie in the buffer just as the file has them.
bool are_native(const PictureDesc& desc, const OIIO::ImageBuf& pixels)
{
    return pixels.localpixels() && pixels.contiguous() && pixels.nchannels() == int(desc.channels.size())
        && pixels.spec().width == int(desc.data.width) && pixels.spec().height == int(desc.data.height)
        && std::all_of(desc.channels.begin(), desc.channels.end(),
                       [&](const ChannelDesc& channel) { return type_desc(channel.type) == pixels.pixeltype(); });
}

}  // namespace

Status open_decoder(OIIO::Filesystem::IOProxy* proxy, Decoder& decoder)
{
    DecodeLimits limits;
    limits.channels = std::uint32_t(std::clamp(OIIO::get_int_attribute("limits:channels", 1024), 1, 1024));
    const int megabytes = OIIO::get_int_attribute("limits:imagesize_MB", 32768);
    const int side = OIIO::get_int_attribute("limits:resolution", 0);  // from OpenImageIO 3.2 on
    if (side > 0)
        limits.side = std::min(limits.side, std::uint32_t(side));
    if (megabytes > 0)
        limits.sample_bytes = std::uint64_t(megabytes) << 20;
    return decoder.open(std::make_shared<ProxySource>(proxy), limits);
}

ProgressiveImage::StoredHierarchy stored_hierarchy(const Decoder& decoder, const OIIO::ImageBuf& pixels)
{
    return [&](const std::vector<const float*>& channels, Hierarchy& hierarchy, std::vector<Bands>& bands) -> Status {
        const PictureDesc& desc = decoder.desc();
        if (are_native(desc, pixels))
            return decoder.read_hierarchy(interleaved(desc, pixels.localpixels()), channels, hierarchy, bands);
        std::vector<std::uint8_t> samples(desc.pixels() * desc.pixel_bytes());
        const Status status = decoder.read(interleaved(desc, static_cast<void*>(samples.data())));
        if (!status)
            return status;
        return decoder.read_hierarchy(interleaved(desc, static_cast<const void*>(samples.data())), channels, hierarchy,
                                      bands);
    };
}

}  // namespace io
}  // namespace pimg
