// SPDX-License-Identifier: BSD-3-Clause
#include "collapse_sequence.h"
namespace pimg {
Status write_collapse_sequence(const Hierarchy&, const PictureDesc&, const std::vector<ConstPlane>&, CollapseChunks&) { return {}; }
std::vector<std::int32_t> diagonal_guide(const PictureDesc&, const std::vector<ConstPlane>&) { return {}; }
Status read_collapse_sequence(const std::vector<ByteSpan>&, int, int, const std::vector<std::int32_t>&, const std::vector<const float*>&, Hierarchy&, std::vector<Bands>&) { return Status::failure("not yet"); }
}
