// SPDX-License-Identifier: BSD-3-Clause
#include "session/pimg_file.h"

#include <vector>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

#include "pimg_pvt.h"

namespace pimgtool {

namespace {

using pimg::format;

/// Chunks of one kind, which lie together.
struct ChunkKind {
    std::string type;
    std::size_t count;
    std::uint64_t bytes;
};

constexpr std::uint64_t kChunkFrame = 20;  ///< bytes of a chunk around its contents

std::vector<ChunkKind> kinds_of(const std::vector<pimg::ChunkInfo>& chunks)
{
    std::vector<ChunkKind> kinds;
    for (const pimg::ChunkInfo& chunk : chunks) {
        if (kinds.empty() || kinds.back().type != chunk.type)
            kinds.push_back({ chunk.type, 0, 0 });
        ++kinds.back().count;
        kinds.back().bytes += chunk.length + kChunkFrame;
    }
    return kinds;
}

const char* meaning(const std::string& type)
{
    static const std::pair<const char*, const char*> meanings[] = {
        { "HEAD", "sizes" },
        { "CHAN", "channels" },
        { "META", "metadata" },
        { "MESH", "base mesh" },
        { "BATC", "vertex splits: the preview" },
        { "RAST", "tiles of exact samples" },
        { "COLL", "hierarchy" },
        { "DONE", "end" },
    };
    for (const auto& [name, words] : meanings)
        if (type == name)
            return words;
    return "unknown";
}

std::string window_text(const pimg::Window& window)
{
    return format("{} x {} at ({}, {})", window.width, window.height, window.x, window.y);
}

}  // namespace

StoredHierarchy::StoredHierarchy(const std::string& filename) : m_proxy(filename, OIIO::Filesystem::IOProxy::Read) { }

std::shared_ptr<StoredHierarchy> StoredHierarchy::open(const std::string& filename, const OIIO::ImageSpec& spec)
{
    using pimg::io::kUnassociatedAlpha;
    std::shared_ptr<StoredHierarchy> stored(new StoredHierarchy(filename));
    if (!stored->m_proxy.opened() || !pimg::io::open_decoder(&stored->m_proxy, stored->m_decoder).ok()
        || !stored->m_decoder.has_hierarchy())
        return nullptr;
    const OIIO::ImageSpec file = pimg::io::to_spec(stored->m_decoder.desc());
    const bool same = file.get_int_attribute(kUnassociatedAlpha) == spec.get_int_attribute(kUnassociatedAlpha);
    return same ? stored : nullptr;
}

bool StoredHierarchy::read(const OIIO::ImageBuf& pixels, const pimg::BuildOptions& options,
                           pimg::ProgressiveImage& image) const
{
    return image.adopt(pixels, pimg::io::stored_hierarchy(m_decoder, pixels), options);
}

std::unique_ptr<OIIO::ImageInput> pimg_input(const std::string& filename)
{
    std::unique_ptr<OIIO::ImageInput> input = pimg::io::make_input();
    return input->valid_file(filename) ? std::move(input) : nullptr;
}

bool has_pimg_extension(const std::string& filename)
{
    return OIIO::Strutil::iequals(OIIO::Filesystem::extension(filename), ".pimg");
}

std::unique_ptr<OIIO::ImageOutput> create_output(const std::string& filename, const pimg::Hierarchy* hierarchy)
{
    if (has_pimg_extension(filename))
        return pimg::io::make_output(hierarchy);
    return OIIO::ImageOutput::create(filename);
}

bool describe_file(const std::string& filename, std::string& text)
{
    OIIO::Filesystem::IOFile proxy(filename, OIIO::Filesystem::IOProxy::Read);
    if (!proxy.opened()) {
        text = format("cannot read \"{}\": no such file", filename);
        return false;
    }
    pimg::Decoder decoder;
    std::vector<pimg::ChunkInfo> chunks;
    pimg::Status status = pimg::io::open_decoder(&proxy, decoder);
    if (status)
        status = decoder.chunks(chunks);
    if (!status) {
        text = format("cannot read \"{}\": {}", filename, status.error());
        return false;
    }
    const pimg::PictureDesc& desc = decoder.desc();
    const double pixels = double(desc.pixels());
    text = format("{}: {} profile, {} bytes, {:.2f} bits/pixel\n", filename,
                  decoder.profile() == pimg::Profile::full ? "full" : "compact", proxy.size(),
                  8.0 * double(proxy.size()) / pixels);
    text += format("  data window     {}\n  display window  {}\n", window_text(desc.data), window_text(desc.display));
    text += format("  tiles           {} x {}\n", decoder.tile(), decoder.tile());
    text += format("  sample hash     {:016x}\n", decoder.sample_hash());
    for (const pimg::ChannelDesc& channel : desc.channels)
        text += format("  channel         {} {}\n", channel.name, pimg::io::type_desc(channel.type).c_str());
    text += "  chunks  count       bytes  bits/pixel\n";
    for (const ChunkKind& kind : kinds_of(chunks))
        text += format("  {}  {:7} {:11} {:11.3f}  {}\n", kind.type, kind.count, kind.bytes,
                       8.0 * double(kind.bytes) / pixels, meaning(kind.type));
    if (chunks.empty() || std::string(chunks.back().type) != "DONE")
        text += "  the file ends early\n";
    return true;
}

}  // namespace pimgtool
