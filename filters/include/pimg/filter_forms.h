// SPDX-License-Identifier: BSD-3-Clause
// The four forms every filter of imagebufalgo.h has, made from the one that works: on a hierarchy, into `dst`.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <pimg/progressive_image.h>

namespace pimg {
namespace ImageBufAlgo {

/// Builds the hierarchy of a plain picture with default options. False, with an error in `dst`, if it cannot be.
bool build_source(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src, int nthreads, ProgressiveImage& progressive);

/// The message of a filter that failed without one.
void set_failed(OIIO::ImageBuf& result, const char* name);

/// A filter to be called in any of four forms. It is an object rather than four functions, so that the forms are written
/// once; it converts to a pointer to the function that works, for tables.
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
}  // namespace pimg
