// SPDX-License-Identifier: BSD-3-Clause
// The part of the OpenFX interface that the plug-in and the test host use: names, values and layouts as the public
// specification (openfx.readthedocs.io) states them. With PIMG_OFX_OFFICIAL defined, the official headers are used in
// place of ours, and ofx_abi_check.cpp compares the two.
#pragma once

#include "ofx_abi_names.h"

#ifdef PIMG_OFX_OFFICIAL

#include <ofxColour.h>
#include <ofxCore.h>
#include <ofxImageEffect.h>
#include <ofxMemory.h>
#include <ofxMessage.h>
#include <ofxMultiThread.h>
#include <ofxParam.h>
#include <ofxProgress.h>
#include <ofxProperty.h>
#include <ofxTimeLine.h>

#else

#include <climits>
#include <cstddef>

#define PIMG_OFX_DEFINE_TEXT(name, value) inline constexpr char name[] = value;
#define PIMG_OFX_DEFINE_NUMBER(name, value) inline constexpr int name = value;
PIMG_OFX_TEXTS(PIMG_OFX_DEFINE_TEXT)
PIMG_OFX_NUMBERS(PIMG_OFX_DEFINE_NUMBER)
#undef PIMG_OFX_DEFINE_TEXT
#undef PIMG_OFX_DEFINE_NUMBER

#include "ofx_abi_types.h"

#endif

/// Names of properties that end in the name of a clip, and the prefix of references to a clip's colour space; the official
/// headers have no constants for them.
inline constexpr char kClipRegionOfInterest[] = "OfxImageClipPropRoI_";
inline constexpr char kClipComponents[] = "OfxImageClipPropComponents_";
inline constexpr char kClipPreferredColourspaces[] = "OfxImageClipPropPreferredColourspaces_";
inline constexpr char kColourspaceOfClip[] = "OfxColourspace_";
