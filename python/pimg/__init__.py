# SPDX-License-Identifier: BSD-3-Clause
"""Progressive images (Lee, Yoon and Lee 2008): tone mapping, smoothing, detail enhancement, segmentation and painting
that know where the features of a picture are.

    import OpenImageIO as oiio, pimg

    p = pimg.build(oiio.ImageBuf("in.exr"))        # once; most of the time goes here
    pimg.srgb_encoded(p.hdr_compress(beta=4)).write("out.png")

Every filter is a function of a picture and a method of ProgressiveImage. Pictures are OpenImageIO.ImageBuf or NumPy arrays.
Importing pimg teaches OpenImageIO in this process to read and write .pimg files.
"""

try:
    import OpenImageIO as _OpenImageIO  # first: it tells pybind11 what an ImageBuf is
except ImportError:  # then there are arrays
    _OpenImageIO = None

from . import _pimg
from ._pimg import *
from ._pimg import __version__

__all__ = ["__version__"] + [name for name in vars(_pimg) if not name.startswith("_")]
