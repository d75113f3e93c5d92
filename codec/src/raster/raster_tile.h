// SPDX-License-Identifier: BSD-3-Clause
// One channel of one raster tile: lossless prediction + residuals. Independent of every other tile.
#pragma once

#include <cstdint>
#include <vector>

#include "entropy/bytes.h"
#include "entropy/symbol_coder.h"

namespace pimg {
inline namespace PIMG_ABI {

/// How a sample is predicted from its neighbours W, N, NW and NE.
enum class Shape : std::uint8_t { none = 0, left = 1, median = 2, mean = 3 };

struct TilePredictor {
    Shape shape = Shape::median;
    bool gouraud = false;  ///< applied to the differences from the mesh layer instead of the samples
};

/// The samples of one channel of a tile, row-major without gaps.
struct TileChannel {
    int width = 0, height = 0;
    std::int32_t* values = nullptr;
    const std::int32_t* gouraud = nullptr;  ///< the mesh layer there; needed by predictors that use it
    /// Size of the residuals of the channel before this one (saturated at 65535), or nullptr for the first.
    const std::uint16_t* guide = nullptr;
    std::uint16_t* sizes = nullptr;  ///< receives the sizes of this channel's residuals

    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};

/// Appends the smaller of two codings of the residuals: by the symbol coder, or as byte planes packed by zstd.
void write_tile_channel(const TileChannel& channel, TilePredictor predictor, Bytes& out);

/// Bits, in 1/256, the residuals would take: an estimate without the coding itself.
std::uint64_t estimate_tile_channel(const TileChannel& channel, TilePredictor predictor);

/// Reads one channel of a tile.
class TileChannelReader {
public:
    /// Reads the head and takes the stream; false when it is damaged. The bytes must stay alive.
    bool open(ByteReader& in, std::size_t pixels);
    bool uses_gouraud() const { return m_predictor.gouraud; }

    /// Decodes the channel; false when it is damaged.
    bool read(const TileChannel& channel);

private:
    TilePredictor m_predictor;
    bool m_planar = false;
    SymbolReader m_symbols;
    std::uint32_t m_planes = 0;
    Bytes m_bytes;
};

}  // namespace PIMG_ABI
}  // namespace pimg
