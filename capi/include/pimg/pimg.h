/* SPDX-License-Identifier: BSD-3-Clause
 * pimg for C, and for every language that can call C. Build the hierarchy of a picture once, then render filters on it
 * as often as you like, as a whole or in windows. The samples are in memory of yours.
 *
 * No function throws or prints anything. All functions may be called from several threads at the same time, also with
 * the same image; only while pimg_free() frees an image, nothing else may use it.
 *
 * Errors: a function that fails writes one line into `error`, cut to error_size - 1 bytes and a 0. `error` may be NULL. A
 * function that succeeds leaves it unchanged.
 */
#ifndef PIMG_PIMG_H
#define PIMG_PIMG_H

#include <stdbool.h>
#include <stddef.h>

#if defined(__GNUC__)
#define PIMG_API __attribute__((visibility("default")))
#elif defined(_WIN32) && defined(PIMG_BUILDING_C_API)
#define PIMG_API __declspec(dllexport)
#else
#define PIMG_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The names are those of a C library. NOLINTBEGIN(readability-identifier-naming) */

/* Float samples: channel c of pixel (x, y) is at (char*)data + y * ystride + x * xstride + 4 * c. Strides are in bytes. 0
 * means that there are no gaps. Strides may be negative, as for rows from the bottom up. Sides are 1 to 2^20 pixels. One
 * channel is luminance, three are R G B, and four are R G B A with associated (premultiplied) alpha. */
typedef struct pimg_pixels {
    float* data;
    int width, height, channels;
    ptrdiff_t xstride, ystride;
} pimg_pixels;

/* A picture with its hierarchy. It has a copy of the samples. */
typedef struct pimg_image pimg_image;

/* Builds the hierarchy of a picture, which takes most of the time. `options` are those that `pimgtool --help build`
 * lists, like "incolorspace=acescg:mesh=adaptive"; NULL or "" for none. Without a colour space, the samples are taken as
 * scene-linear light: with Rec. 709 primaries, or those of the role scene_linear if $OCIO names an OpenColorIO
 * configuration. Returns NULL on failure. */
PIMG_API pimg_image* pimg_build(const pimg_pixels* picture, const char* options, char* error, size_t error_size);

/* Renders a filter. `filter` is its name with its options, as in "hdr_compress:s0=0.1:beta=4"; `pimgtool --help` lists
 * them. `result` is a window of the picture, and pixel (x, y) of the picture is the upper left pixel of the window; x and
 * y are -2^30 to 2^30. A window receives the same pixels as the whole picture would have there, and parts of it outside
 * the picture stay as they were. Labels and boundaries, as segment makes them, go to the first channel. Channels that a
 * filter does not change, such as alpha, are copied. nthreads is the number of threads, 0 for all cores; it never changes
 * a result. */
PIMG_API bool pimg_render(const pimg_image* image, const char* filter, const pimg_pixels* result, int x, int y,
                          int nthreads, char* error, size_t error_size);

/* The number of bytes that the image takes, caches included; 0 for NULL. */
PIMG_API size_t pimg_memory(const pimg_image* image);

/* Frees an image. Does nothing for NULL. */
PIMG_API void pimg_free(pimg_image* image);

/* The version of the library, like "0.1.0". */
PIMG_API const char* pimg_version(void);

/* NOLINTEND(readability-identifier-naming) */

#ifdef __cplusplus
}
#endif

#endif
