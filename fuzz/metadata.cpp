// SPDX-License-Identifier: BSD-3-Clause
// Metadata as a file has it: the attributes of a META chunk become those of an OpenImageIO header, ICC profiles among them,
// and go back. A second trip must change nothing.
#include <cstdint>
#include <string>

#include "container.h"
#include "pimg_pvt.h"
#include "taken.h"

using namespace pimg;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    PictureDesc desc;
    desc.data = desc.display = { 0, 0, 4, 4 };
    desc.channels = { { "R", SampleType::half }, { "G", SampleType::uint8 }, { "B", SampleType::float32 } };
    DecodeLimits limits;
    limits.attribute_bytes = 1 << 20;
    if (!read_attributes(ByteReader(data, size), limits, desc))
        return 0;
    const OIIO::ImageSpec once = io::to_spec(desc);
    const PictureDesc kept = io::to_desc(once);
    const PictureDesc twice = io::to_desc(io::to_spec(kept));
    must(kept.attributes.size() == twice.attributes.size());
    for (std::size_t i = 0; i < kept.attributes.size(); ++i) {
        const Attribute &a = kept.attributes[i], &b = twice.attributes[i];
        must(a.name == b.name && a.type == b.type && a.value == b.value);
    }
    must(!once.serialize(OIIO::ImageSpec::SerialText).empty());
    return 0;
}
