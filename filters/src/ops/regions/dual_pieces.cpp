// SPDX-License-Identifier: BSD-3-Clause
// The partition of the picture by the vertices of one level (paper, section 4.2).
#include <pimg/dual_pieces.h>

#include <pimg/detail/format.h>
#include <pimg/imagebufalgo.h>

#include "ops/regions/partition.h"
#include "source/wrap/wrapped_pieces.h"

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

bool on_hierarchy::dual_pieces(ImageBuf& dst, const ProgressiveImage& src, const DualPiecesOptions& options, ROI roi,
                               int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare_partition(dst, src, roi, options.output))
            return false;
        const Hierarchy& hierarchy = src.data()->hierarchy;
        Level level = 0;
        std::string error;
        DualPieces pieces;
        if (!find_level(hierarchy, options, level, error)) {
            set_error(dst, error);
            return false;
        }
        if (const Status status = DualPieces::from_hierarchy(hierarchy, pieces); !status) {
            set_error(dst, status.error());
            return false;
        }
        Partition partition { pieces.count(level), {} };
        partition.labels = wrapped_pieces(src.data()->wrap, pieces.labels(level), partition.count);
        return write_partition(dst, *src.data(), roi, pool_loop(nthreads), partition, options.output);
    });
}

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
