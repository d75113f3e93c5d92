/* SPDX-License-Identifier: BSD-3-Clause
 * pimg for C and every language that can call it: build the hierarchy of a picture once, then render filters on it as
 * often as you like, whole or in windows. Samples stay in memory of yours.
 *
 * Nothing is thrown, printed or kept but the image. All functions may be called from several threads at once, also with
 * the same image; only pimg_free() must be alone with it.
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

/* Float samples: channel c of pixel (x, y) is at (char*)data + y * ystride + x * xstride + 4 * c. Strides are in bytes;
 * 0 means packed, and a negative one is fine: rows from the bottom up. Channels are Y, R G B, or R G B A; alpha is
 * associated (premultiplied). */
typedef struct pimg_pixels {
    float* data;
    int width, height, channels;
    ptrdiff_t xstride, ystride;
} pimg_pixels;

/* A picture with its hierarchy. Holds a copy of the samples. */
typedef struct pimg_image pimg_image;

/* Builds the hierarchy of a picture; most of the time goes here. `options` are those of `pimgtool --help build`, like
 * "incolorspace=acescg:mesh=adaptive"; NULL or "" for none. Without a colour space samples are scene-linear light with
 * Rec. 709 primaries. NULL on failure. */
PIMG_API pimg_image* pimg_build(const pimg_pixels* picture, const char* options, char* error, size_t error_size);

/* Renders a filter: its name and options as in "hdr_compress:s0=0.1:beta=4"; `pimgtool --help` lists them.
 * `result` is a window of the picture whose upper left pixel is (x, y) of it; parts outside stay as they were, x and y
 * lie within 2^30. A window holds just what rendering the whole picture puts there. Labels and boundaries of segment go to the first channel;
 * channels that a filter does not change, such as alpha, are copied. nthreads: 0 for all cores; never changes a result. */
PIMG_API bool pimg_render(const pimg_image* image, const char* filter, const pimg_pixels* result, int x, int y,
                          int nthreads, char* error, size_t error_size);

/* Bytes held, caches included. */
PIMG_API size_t pimg_memory(const pimg_image* image);

/* NULL is fine. */
PIMG_API void pimg_free(pimg_image* image);

/* "0.1.0" */
PIMG_API const char* pimg_version(void);

/* Errors: a function that fails writes one line, cut to error_size - 1 bytes, into `error`, which may be NULL. One that
 * succeeds leaves it alone. */

#ifdef __cplusplus
}
#endif

#endif
