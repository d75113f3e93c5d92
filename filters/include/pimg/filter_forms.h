// SPDX-License-Identifier: BSD-3-Clause
// Makes the four forms in which every filter of imagebufalgo.h can be called from one function: the form that takes a
// ProgressiveImage and writes into `dst`.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/progressive_image.h>

namespace pimg {
inline namespace PIMG_ABI {
namespace ImageBufAlgo {

/// Builds the hierarchy of a plain picture with default options. On failure returns false and sets the error of `dst`.
PIMG_EXPORT bool build_source(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src, int nthreads,
                              ProgressiveImage& progressive);

/// Sets the error of `result` when the filter `name` failed without setting one.
PIMG_EXPORT void set_failed(OIIO::ImageBuf& result, const char* name);

/// A filter that can be called in four forms, which are listed in imagebufalgo.h. It is an object and not four functions,
/// so that the forms are written only once. It converts to a pointer to its function, for tables of filters.
template<class Options>
class FilterForms {
public:
    using ImageBuf = OIIO::ImageBuf;
    using ROI = OIIO::ROI;
    using Function = bool (*)(ImageBuf& dst, const ProgressiveImage& src, const Options& options, ROI roi,
                              int nthreads);

    constexpr FilterForms(const char* name, Function function) : m_name(name), m_function(function) { }

    constexpr operator Function() const { return m_function; }

    bool operator()(ImageBuf& dst, const ProgressiveImage& src, const Options& options = {}, ROI roi = {},
                    int nthreads = 0) const
    {
        return m_function(dst, src, options, roi, nthreads);
    }
    bool operator()(ImageBuf& dst, const ImageBuf& src, const Options& options = {}, ROI roi = {},
                    int nthreads = 0) const
    {
        ProgressiveImage progressive;
        return build_source(dst, src, nthreads, progressive) && m_function(dst, progressive, options, roi, nthreads);
    }
    ImageBuf operator()(const ProgressiveImage& src, const Options& options = {}, ROI roi = {}, int nthreads = 0) const
    {
        return returned(src, options, roi, nthreads);
    }
    ImageBuf operator()(const ImageBuf& src, const Options& options = {}, ROI roi = {}, int nthreads = 0) const
    {
        return returned(src, options, roi, nthreads);
    }

private:
    template<class Source>
    ImageBuf returned(const Source& src, const Options& options, ROI roi, int nthreads) const
    {
        ImageBuf result;
        if (!(*this)(result, src, options, roi, nthreads) && !result.has_error())
            set_failed(result, m_name);
        return result;
    }

    const char* m_name;
    Function m_function;
};

}  // namespace ImageBufAlgo
}  // namespace PIMG_ABI
}  // namespace pimg
