// SPDX-License-Identifier: BSD-3-Clause
// What the binary interface of the libraries rests on: its generation, what shared libraries export, and the machines that
// there are libraries for.
#pragma once

#include <cstdint>

// Vertices are numbered in 32 bits and bytes in 64, and samples are in the byte order of files.
#if UINTPTR_MAX != UINT64_MAX
#error "pimg needs a 64-bit machine"
#endif
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "pimg needs a little-endian machine"
#endif

/// The inline namespace of everything in pimg: of pimg::Mesh, linkers see pimg::v0_2::Mesh. A program that has two
/// generations in it, by way of a plugin for example, calls the right one or does not link. It is the SONAME of the shared
/// libraries, too, and changes with it (docs/versions.md).
#define PIMG_ABI v0_2

/// Public functions and classes with functions outside the header: shared libraries are built with all else hidden.
#if defined(__GNUC__)
#define PIMG_EXPORT __attribute__((visibility("default")))
#else
#define PIMG_EXPORT
#endif
/// What only our own libraries call of each other, in headers under pimg/detail. Any version may change it.
#define PIMG_EXPORT_DETAIL PIMG_EXPORT
