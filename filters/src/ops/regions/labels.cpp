// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/labels.h>

#include <OpenImageIO/half.h>

#include <pimg/detail/format.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

using OIIO::TypeDesc;

/// Writes labels as samples of type T. Each is converted to Via first, and then to T.
template<class T, class Via = T>
bool write_as(OIIO::ImageBuf& dst, OIIO::ROI roi, const Index* labels, std::size_t stride)
{
    for (int y = roi.ybegin; y < roi.yend; ++y, labels += stride)
        for (int x = roi.xbegin; x < roi.xend; ++x)
            *static_cast<T*>(dst.pixeladdr(x, y, roi.zbegin)) = T(Via(labels[x - roi.xbegin]));
    return true;
}

}  // namespace

double largest_label(const TypeDesc& type)
{
    switch (type.basetype) {
    case TypeDesc::UINT8:
        return 255.0;
    case TypeDesc::INT8:
        return 127.0;
    case TypeDesc::UINT16:
        return 65535.0;
    case TypeDesc::INT16:
        return 32767.0;
    case TypeDesc::INT32:
        return 2147483647.0;
    case TypeDesc::HALF:
        return 2048.0;
    case TypeDesc::FLOAT:
        return 16777216.0;
    default:
        return 4294967295.0;
    }
}

bool write_labels(OIIO::ImageBuf& dst, OIIO::ROI roi, const Index* labels, std::size_t stride, Index count)
{
    const TypeDesc type = dst.spec().format;
    if (double(count) - 1.0 > largest_label(type)) {
        set_error(
            dst, format("{} labels: expected at most {} in pixels of type {}", count, largest_label(type) + 1.0, type));
        return false;
    }
    switch (type.basetype) {
    case TypeDesc::UINT8:
        return write_as<std::uint8_t>(dst, roi, labels, stride);
    case TypeDesc::INT8:
        return write_as<std::int8_t>(dst, roi, labels, stride);
    case TypeDesc::UINT16:
        return write_as<std::uint16_t>(dst, roi, labels, stride);
    case TypeDesc::INT16:
        return write_as<std::int16_t>(dst, roi, labels, stride);
    case TypeDesc::UINT32:
        return write_as<std::uint32_t>(dst, roi, labels, stride);
    case TypeDesc::INT32:
        return write_as<std::int32_t>(dst, roi, labels, stride);
    case TypeDesc::HALF:
        return write_as<half, float>(dst, roi, labels, stride);
    case TypeDesc::FLOAT:
        return write_as<float>(dst, roi, labels, stride);
    case TypeDesc::DOUBLE:
        return write_as<double>(dst, roi, labels, stride);
    default:
        set_error(dst, format("labels cannot be stored in pixels of type {}", type));
        return false;
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
