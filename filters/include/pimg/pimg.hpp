// SPDX-License-Identifier: BSD-3-Clause
// All public headers of C++: pimg::filters and what it is built on, and pimg::codec. The header for C is <pimg/pimg.h>.
#pragma once

#include <pimg/bands.h>
#include <pimg/brush.h>
#include <pimg/channels.h>
#include <pimg/codec.h>
#include <pimg/colour.h>
#include <pimg/direction.h>
#include <pimg/display.h>
#include <pimg/dual_pieces.h>
#include <pimg/filter_forms.h>
#include <pimg/filter_table.h>
#include <pimg/gain_map.h>
#include <pimg/guide.h>
#include <pimg/hierarchy.h>
#include <pimg/imagebufalgo.h>
#include <pimg/ink.h>
#include <pimg/labels.h>
#include <pimg/mesh.h>
#include <pimg/mosaic.h>
#include <pimg/option_text.h>
#include <pimg/options.h>
#include <pimg/paint.h>
#include <pimg/progressive_image.h>
#include <pimg/rasterize.h>
#include <pimg/regions.h>
#include <pimg/ring.h>
#include <pimg/sampling.h>
#include <pimg/simplify.h>
#include <pimg/smoothing.h>
#include <pimg/stroke_file.h>
#include <pimg/strokes.h>
#include <pimg/threads.h>
#include <pimg/types.h>
#include <pimg/version.h>
