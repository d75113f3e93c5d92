# SPDX-License-Identifier: BSD-3-Clause
"""The Python module: the same numbers as C++ on ImageBuf and arrays, keywords, errors, threads, files, docstrings, stubs."""

import ast
import inspect
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np
import OpenImageIO as oiio

import pimg

TYPES = ("uint8", "uint16", "float16", "float32", "float64")
# An option of each filter that changes its result.
CHANGES = {
    "hdr_compress": {"beta": 2},
    "feature_lowpass": {"splits": 50},
    "detail_enhance": {"gain": 4.0},
    "dual_pieces": {"vertices": 100},
    "segment": {"regions": 9},
    "paint": {"min": 8},
    "mosaic": {"tiles": 60},
    "ink": {"cross": False},
    "level": {"faces": 100},
    "wireframe": {"faces": 100},
}


def scene(width=61, height=47, channels=3):
    """Shades, an edge, and a disc a thousand times as bright; always the same."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float64)
    light = 0.1 + 0.4 * x / width + 0.02 * np.sin(x * y)
    light[(x - 0.6 * width) ** 2 + (y - 0.4 * height) ** 2 < (0.2 * height) ** 2] = 100
    light[int(0.8 * height) :] *= 0.1
    return (light[..., None] * np.linspace(1, 0.5, channels)).astype(np.float32)


def picture(dtype="float32", **keys):
    pixels = scene(**keys)
    if np.dtype(dtype).kind == "u":
        return (np.clip(pixels, 0, 1) * np.iinfo(dtype).max).astype(dtype)
    return pixels.astype(dtype)


def buffer_of(array):
    names = {"float16": "half", "float32": "float", "float64": "double"}
    height, width, channels = array.shape
    buffer = oiio.ImageBuf(oiio.ImageSpec(width, height, channels, names.get(array.dtype.name, array.dtype.name)))
    buffer.set_pixels(buffer.roi, array)
    return buffer


def pixels_of(buffer):
    return buffer.get_pixels(buffer.spec().format)


class Filters(unittest.TestCase):
    def test_all_filters_are_functions_and_methods(self):
        self.assertEqual(set(CHANGES), set(pimg.filters()))
        p = pimg.build(scene())
        for name in pimg.filters():
            with self.subTest(filter=name):
                method = getattr(p, name)()
                self.assertTrue(np.array_equal(method, getattr(pimg, name)(scene())))
                self.assertTrue(np.array_equal(method, getattr(pimg, name)(p)))
                self.assertEqual(method.shape, (47, 61) if name in ("dual_pieces", "segment") else (47, 61, 3))
                self.assertFalse(np.array_equal(method, getattr(p, name)(**CHANGES[name])), "the option does nothing")

    def test_arrays_and_buffers_give_the_same(self):
        for dtype in TYPES:
            array = picture(dtype)
            flat, full = pimg.build(buffer_of(array)), pimg.build(array)
            for name in pimg.filters():
                with self.subTest(dtype=dtype, filter=name):
                    buffer, result = getattr(flat, name)(), getattr(full, name)()
                    self.assertIsInstance(buffer, oiio.ImageBuf)
                    self.assertIsInstance(result, np.ndarray)
                    expected = pixels_of(buffer).reshape(result.shape)
                    self.assertEqual(result.dtype, expected.dtype)
                    self.assertTrue(np.array_equal(result, expected))

    def test_types_of_results(self):
        for dtype in TYPES:
            p = pimg.build(picture(dtype))
            with self.subTest(dtype=dtype):
                self.assertEqual(p.hdr_compress().dtype, "float32")
                self.assertEqual(p.segment().dtype, "uint32")
                self.assertEqual(p.feature_lowpass().dtype, dtype)
                self.assertEqual(p.detail_enhance().dtype, "float32" if dtype[0] == "u" else dtype)

    def test_what_changes_nothing(self):
        for dtype in TYPES:
            array = picture(dtype)
            p = pimg.build(array)
            self.assertTrue(np.array_equal(p.feature_lowpass(strength=0), array), dtype)
            scale = np.iinfo(dtype).max if dtype[0] == "u" else 1
            enhanced = p.detail_enhance(gain=1) * scale
            self.assertTrue(np.array_equal(np.rint(enhanced) if scale > 1 else enhanced, array), dtype)

    def test_shapes(self):
        for shape in ((20, 30), (20, 30, 1), (20, 30, 2), (20, 30, 4), (20, 30, 7), (1, 1), (1, 9, 3), (9, 1, 3)):
            array = np.resize(scene().ravel(), shape).astype(np.float32)
            with self.subTest(shape=shape):
                p = pimg.build(array)
                self.assertEqual(p.level().shape, shape)
                self.assertTrue(np.allclose(p.level(), array, atol=1e-5 * array.max()))
                self.assertEqual(p.segment(regions=1).shape, shape if shape[2:] == (1,) else shape[:2])
                self.assertEqual((p.width, p.height, len(p.channels)), (shape[1], shape[0], (shape + (1,))[2]))

    def test_alpha_and_further_channels_pass(self):
        array = np.concatenate([scene(), scene(channels=2) + 7], axis=2)
        result = pimg.hdr_compress(array)
        self.assertTrue(np.array_equal(result[..., 3:], array[..., 3:]))
        self.assertFalse(np.array_equal(result[..., :3], array[..., :3]))

    def test_arrays_of_any_layout(self):
        array = scene()
        expected = pimg.hdr_compress(array)
        wide = np.zeros((94, 122, 3), np.float32)
        wide[::2, ::2] = array
        for name, other in (
            ("strided", wide[::2, ::2]),
            ("mirrored", array[::-1, ::-1].copy()[::-1, ::-1]),
            ("Fortran", np.asfortranarray(array)),
            ("other byte order", array.astype(">f4")),
        ):
            self.assertTrue(np.array_equal(pimg.hdr_compress(other), expected), name)

    def test_the_source_is_left_alone_and_copied(self):
        array = scene()
        before = array.copy()
        p = pimg.build(array)
        expected = p.hdr_compress()
        self.assertTrue(np.array_equal(array, before))
        array[:] = 0
        self.assertTrue(np.array_equal(p.hdr_compress(), expected))
        self.assertTrue(np.array_equal(p.feature_lowpass(strength=0), before))

    def test_regions_of_interest(self):
        p, array = pimg.build(buffer_of(scene())), pimg.build(scene())
        for name in ("hdr_compress", "feature_lowpass", "segment", "paint"):
            whole = getattr(array, name)()
            part = getattr(array, name)(roi=(10, 30, 5, 25))
            self.assertTrue(np.array_equal(part, whole[5:25, 10:30]), name)
            roi = oiio.ROI(10, 30, 5, 25, 0, 1, 0, 3)
            self.assertTrue(np.array_equal(pixels_of(getattr(p, name)(roi=roi)).reshape(part.shape), part), name)

    def test_hostile_arguments_are_errors(self):
        array = scene()
        image = pimg.build(array)
        beyond = image.level(roi=(-2**31 + 1, 2**31 - 1, -2**31 + 1, 2**31 - 1))
        self.assertTrue(np.array_equal(beyond, image.level()))
        with self.assertRaisesRegex(ValueError, "overlaps"):
            image.level(roi=(2**30, 2**31 - 1, 0, 10))
        with self.assertRaisesRegex(TypeError, "mask"):
            pimg.level(np.ma.masked_array(array, mask=array > 0.5))

    def test_only_build_and_open_make_pictures(self):
        for make in (pimg.ProgressiveImage, lambda: pimg.ProgressiveImage.__new__(pimg.ProgressiveImage),
                     type("Derived", (pimg.ProgressiveImage,), {"__init__": lambda self: None})):
            with self.assertRaises(TypeError):
                make()

    def test_names_hold_no_zero_characters(self):
        image = pimg.build(scene())
        before = set(os.listdir())
        for call in (lambda: image.save("a\0.pimg"), lambda: pimg.open("a\0.exr"), lambda: image.paint(strokes="a\0.svg"),
                     lambda: image.segment(stats="a\0.csv")):
            with self.assertRaisesRegex(ValueError, "zero character"):
                call()
        self.assertEqual(set(os.listdir()), before)

    def test_quoted_texts_of_any_length_and_kind_are_one_line(self):
        for text in ("x" * 5000, "x " * 5000, "a\nb", "a\x1b[2J"):
            with self.assertRaises(ValueError) as raised:
                pimg.build(scene(), guide=text)
            message = str(raised.exception)
            self.assertLess(len(message), 1600)
            self.assertTrue(message.isprintable(), message)

    def test_buffers_of_modules_that_share_no_classes(self):
        """OpenImageIO 3.2's are made with nanobind, and reached by their methods."""
        foreign = type("ImageBuf", (), {"__init__": lambda self, buffer: setattr(self, "buffer", buffer),
                                        "spec": lambda self: self.buffer.spec(),
                                        "get_pixels": lambda self, format: self.buffer.get_pixels(format)})
        roi = type("ROI", (), {"xbegin": 10, "xend": 30, "ybegin": 5, "yend": 25})()
        for dtype in TYPES:
            own = buffer_of(picture(dtype))
            self.assertTrue(np.array_equal(pimg.hdr_compress(foreign(own)), pixels_of(pimg.hdr_compress(own))), dtype)
            part = pimg.hdr_compress(foreign(own), roi=roi)
            self.assertTrue(np.array_equal(part, pimg.hdr_compress(foreign(own))[5:25, 10:30]), dtype)
        own = buffer_of(scene(channels=4))
        plain = pimg.hdr_compress(foreign(own))
        own.specmod().alpha_channel = -1
        own.specmod().channelnames = ("R", "G", "B", "mask")
        self.assertFalse(np.array_equal(pimg.hdr_compress(foreign(own)), plain))
        own = buffer_of(picture("float32"))
        own.specmod().attribute("oiio:ColorSpace", "ACEScg")
        self.assertFalse(np.array_equal(pimg.hdr_compress(foreign(own)), pimg.hdr_compress(scene())))
        with self.assertRaisesRegex(ValueError, "pixels"):
            pimg.build(foreign(oiio.ImageBuf("no such file.exr")))
        with self.assertRaisesRegex(TypeError, "ROI"):
            pimg.build(scene()).level(roi=type("ROI", (), {})())

    def test_buffers_keep_windows_and_metadata(self):
        spec = oiio.ImageSpec(61, 47, 3, "half")
        spec.x, spec.y, spec.full_width, spec.full_height = 5, -7, 100, 90
        spec.attribute("Artist", "nobody")
        source = oiio.ImageBuf(spec)
        source.set_pixels(source.roi, scene())
        result = pimg.hdr_compress(source)
        self.assertEqual((result.spec().x, result.spec().y, result.spec().full_width), (5, -7, 100))
        self.assertEqual(result.spec().get_string_attribute("Artist"), "nobody")

    def test_whole_numbers_are_srgb_and_floats_are_light(self):
        p = pimg.build(picture("uint8"))
        self.assertEqual((p.guide, pimg.build(scene()).guide), ("luma", "log"))
        linear = pimg.build(picture("uint8"), incolorspace="linear").hdr_compress(fit=False, s0=1)
        self.assertTrue(np.allclose(linear, picture("uint8") / 255, atol=1e-5))
        encoded = pimg.srgb_encoded(p.hdr_compress(fit=False, s0=1))
        self.assertTrue(np.allclose(encoded, picture("uint8") / 255, atol=1e-4))

    def test_found_options_fix_the_look(self):
        p = pimg.build(scene())
        found = p.resolve_hdr_compress(beta=3)
        self.assertEqual(found["beta"], 3)
        self.assertGreater(found["dmax"], 0)
        self.assertTrue(np.array_equal(p.hdr_compress(**found), p.hdr_compress(beta=3)))


class Keywords(unittest.TestCase):
    def setUp(self):
        self.p = pimg.build(scene())

    def test_values_may_be_of_any_fitting_type(self):
        expected = self.p.hdr_compress(beta=4, fit=True)
        for beta in (4.0, np.float32(4), np.int64(4), "4"):
            self.assertTrue(np.array_equal(self.p.hdr_compress(beta=beta, fit=np.bool_(True)), expected))
        self.assertTrue(np.array_equal(self.p.feature_lowpass(splits=None), self.p.feature_lowpass()))
        early = self.p.detail_enhance(from_=0.01)
        self.assertFalse(np.array_equal(early, self.p.detail_enhance()))
        curve = self.p.detail_enhance(curve="0:1,0.5:3")
        self.assertTrue(np.array_equal(curve, self.p.detail_enhance(curve=("0:1", "0.5:3"))))
        self.assertTrue(np.array_equal(self.p.mosaic(color=(0.1, 0.2, 0.3)), self.p.mosaic(color="0.1,0.2,0.3")))

    def test_paths(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "regions.csv")
            self.p.segment(regions=5, stats=path)
            self.assertEqual(len(path.read_text().splitlines()), 6)

    def check(self, kind, says, call):
        with self.assertRaises(kind) as raised:
            call()
        self.assertIn(says, str(raised.exception))
        self.assertNotIn("\n", str(raised.exception))

    def test_errors_are_one_line_that_says_what_was_expected(self):
        p, array = self.p, scene()
        nan = float("nan")
        for kind, says, call in (
            (ValueError, 'beta="-1": expected a number, 0 to 1000', lambda: p.hdr_compress(beta=-1)),
            (ValueError, "expected a number", lambda: p.hdr_compress(beta="fast")),
            (ValueError, "expected a number", lambda: p.hdr_compress(beta=nan)),
            (ValueError, "a whole number", lambda: p.segment(regions=2.5)),
            (ValueError, "only one of them", lambda: p.level(faces=10, splits=3)),
            (ValueError, "one of labels, mean, boundaries", lambda: p.segment(output="x")),
            (ValueError, "one of luma, log, rgb", lambda: pimg.build(array, guide="chroma")),
            (TypeError, 'unknown option "betta": expected s0, beta', lambda: p.hdr_compress(betta=1)),
            (TypeError, "unknown option", lambda: pimg.hdr_compress(array, guide="log")),
            (TypeError, "not str", lambda: pimg.hdr_compress("in.exr")),
            (TypeError, "not list", lambda: pimg.build([[1, 2], [3, 4]])),
            (TypeError, "int64", lambda: pimg.build(array.astype(np.int64))),
            (TypeError, "bool", lambda: pimg.build(array > 1)),
            (ValueError, "shape (47,)", lambda: pimg.build(array[:, 0, 0])),
            (ValueError, "shape (0, 4)", lambda: pimg.build(np.zeros((0, 4), np.float32))),
            (TypeError, "roi", lambda: p.level(roi=(1, 2))),
            (ValueError, "overlaps", lambda: p.level(roi=(1000, 1100, 0, 10))),
            (ValueError, "not initialized", lambda: pimg.build(oiio.ImageBuf())),
            (ValueError, "nowhere.exr", lambda: pimg.build(oiio.ImageBuf("nowhere.exr"))),
            (ValueError, "unknown filter", lambda: pimg.options("nothing")),
        ):
            self.check(kind, says, call)

    def test_options_tell_ranges(self):
        beta = next(row for row in pimg.options("hdr_compress") if row["name"] == "beta")
        self.assertEqual((beta["type"], beta["default"], beta["min"], beta["max"]), ("float", 10.0, 0.0, 1000.0))
        self.assertEqual(next(row for row in pimg.options("segment"))["default"], None)
        for name in pimg.filters() + ["build", "save"]:
            for row in pimg.options(name):
                self.assertTrue(row["help"])


class Concurrency(unittest.TestCase):
    def test_the_gil_is_released(self):
        """Python goes on while a hierarchy is built."""
        ticks = []
        done = threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        start = time.perf_counter()
        pimg.build(scene(width=500, height=400))
        end = time.perf_counter()
        done.set()
        thread.join()
        during = [t for t in ticks if start < t < end]
        self.assertGreater(len(during), 5)

    def test_threads_share_an_image_and_change_nothing(self):
        p = pimg.build(scene())
        alone = {name: getattr(p, name)(nthreads=1) for name in pimg.filters()}
        q = pimg.build(scene(), nthreads=1)
        failures = []

        def work(names):
            for name in names:
                if not np.array_equal(getattr(q, name)(), alone[name]):
                    failures.append(name)

        threads = [threading.Thread(target=work, args=(order,)) for order in (pimg.filters(), pimg.filters()[::-1])]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_progress_and_stopping(self):
        shares = []
        array = scene(width=400, height=300)
        pimg.build(array, progress=shares.append)
        self.assertEqual(shares, sorted(shares))
        self.assertGreater(len(shares), 2)

        def stop(share):
            raise KeyError("enough")

        with self.assertRaises(KeyError):
            pimg.build(array, progress=stop)

    def test_ctrl_c_stops_building(self):
        signal.signal(signal.SIGINT, signal.default_int_handler)
        threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            pimg.build(scene(width=900, height=700))


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_saved_and_opened(self):
        for dtype in TYPES[:4]:
            array = picture(dtype)
            array[3, 4, 1] = np.nan if dtype[0] == "f" else 0
            p, path = pimg.build(array), self.folder / f"{dtype}.pimg"
            p.save(path)
            q = pimg.open(path, array=True)
            with self.subTest(dtype=dtype):
                self.assertTrue(np.array_equal(q.feature_lowpass(strength=0), array, equal_nan=dtype[0] == "f"))
                self.assertEqual(q.splits, p.splits)
                self.assertLess(np.abs(q.hdr_compress() - p.hdr_compress()).max(), 0.02)
                buffer = oiio.ImageBuf(str(path))
                self.assertTrue(np.array_equal(pixels_of(buffer), array, equal_nan=dtype[0] == "f"))

    def test_profiles(self):
        p = pimg.build(picture("uint8"))
        p.save(self.folder / "full.pimg")
        p.save(self.folder / "compact.pimg", profile="compact")
        self.assertLess((self.folder / "compact.pimg").stat().st_size, (self.folder / "full.pimg").stat().st_size)
        opened = pimg.open(self.folder / "compact.pimg", array=True)
        self.assertTrue(np.array_equal(opened.feature_lowpass(strength=0), picture("uint8")))

    def test_the_colour_space_is_kept(self):
        path = self.folder / "aces.pimg"
        plain, aces = pimg.build(scene()), pimg.build(scene(), incolorspace="acescg")
        aces.save(path)
        expected = aces.hdr_compress(fit=False, s0=0.5)
        for opened in (pimg.open(path, array=True), pimg.open(path, array=True, incolorspace="acescg")):
            self.assertLess(np.abs(opened.hdr_compress(fit=False, s0=0.5) - expected).mean(), 1e-4 * expected.max())
        self.assertGreater(np.abs(plain.hdr_compress(fit=False, s0=0.5) - expected).mean(), 1e-3 * expected.max())

    def test_other_files_and_results_that_are_buffers(self):
        name = str(self.folder / "in.exr")
        buffer_of(scene()).write(name)
        p = pimg.open(name, guide="log")
        self.assertIsInstance(p.hdr_compress(), oiio.ImageBuf)
        self.assertTrue(np.array_equal(pixels_of(p.hdr_compress()), pimg.hdr_compress(scene())))

    def test_a_layer_is_named_while_building_and_reading(self):
        layers = {name: scene() * factor for name, factor in (("key", 1), ("fill", (0.2, 3, 1)))}
        buffer = buffer_of(np.concatenate([*layers.values()], 2).astype(np.float32))
        buffer.specmod().channelnames = [f"{name}.{c}" for name in layers for c in "RGB"]
        exr, path = str(self.folder / "in.exr"), self.folder / "in.pimg"
        buffer.write(exr)
        pimg.build(buffer, layer="key").save(path)
        with self.assertRaisesRegex(ValueError, "one of key, fill"):
            pimg.build(buffer)

        def channels(result, layer):  # files have an order of their own
            return pixels_of(result)[..., [result.spec().channelindex(f"{layer}.{c}") for c in "RGB"]]

        for name, other in (("key", "fill"), ("fill", "key")):
            expected = pimg.hdr_compress(layers[name].astype(np.float32))
            for source in (pimg.build(buffer, layer=name), pimg.open(exr, layer=name), pimg.open(path, layer=name)):
                result = source.hdr_compress()
                self.assertTrue(np.array_equal(channels(result, name), expected))
                self.assertTrue(np.array_equal(channels(result, other), layers[other].astype(np.float32)))
            read = oiio.ImageBuf(f"{path}?hdr_compress=1&layer={name}")
            self.assertTrue(np.array_equal(channels(read, name), expected))

    def test_sides_that_meet(self):
        array = scene(96, 48)
        plain, around = pimg.build(array), pimg.build(array, wrap="x")
        self.assertGreater(around.vertices, plain.vertices)
        self.assertEqual(around.hdr_compress().shape, array.shape)
        around.save(self.folder / "around.pimg")  # a stored mesh has no margins
        self.assertEqual(pimg.open(self.folder / "around.pimg").vertices, plain.vertices)
        with self.assertRaisesRegex(ValueError, "expected one of none, x, xy"):
            pimg.build(array, wrap="y")

    def test_openimageio_reads_and_writes_pimg_after_the_import(self):
        name = str(self.folder / "a.pimg")
        self.assertTrue(buffer_of(picture("uint8")).write(name))
        small = oiio.ImageBuf(name + "?level=0")
        self.assertTrue(small.read(), small.geterror())

    def test_errors_name_the_file(self):
        (self.folder / "text.exr").write_text("no picture")
        p = pimg.build(scene())
        for call, name in (
            (lambda: pimg.open(self.folder / "none.exr"), "none.exr"),
            (lambda: pimg.open(self.folder / "none.pimg"), "none.pimg"),
            (lambda: pimg.open(self.folder / "text.exr"), "text.exr"),
            (lambda: p.save(self.folder / "nowhere" / "a.pimg"), "a.pimg"),
        ):
            with self.assertRaises(OSError) as raised:
                call()
            self.assertIn(name, str(raised.exception))
            self.assertNotIn("\n", str(raised.exception))
        with self.assertRaises(ValueError):
            p.save(self.folder / "a.png")
        self.assertEqual(os.listdir(self.folder), ["text.exr"])


class Documentation(unittest.TestCase):
    def test_docstrings_describe_every_option(self):
        for name in pimg.filters():
            for function in (getattr(pimg, name), getattr(pimg.ProgressiveImage, name)):
                keywords = list(inspect.signature(function).parameters)
                doc = inspect.getdoc(function)
                for row in pimg.options(name):
                    self.assertIn(row["name"], keywords)
                    self.assertIn(f"\n{row['name']} : ", doc)
                    self.assertIn(row["help"], doc)
                for word in ("Returns", "Raises", "roi", "nthreads"):
                    self.assertIn(word, doc)
        self.assertEqual(inspect.signature(pimg.hdr_compress).parameters["beta"].default, 10)
        self.assertIn("section 5.1", pimg.hdr_compress.__doc__)

    def test_the_stub_has_everything(self):
        folder = pathlib.Path(pimg.__file__).parent
        self.assertTrue((folder / "py.typed").exists())
        tree = ast.parse((folder / "__init__.pyi").read_text())
        names = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        self.assertEqual(names, set(pimg.__all__) - {"__version__"})
        members = next(node for node in tree.body if isinstance(node, ast.ClassDef)).body
        public = {name for name in vars(pimg.ProgressiveImage) if not name.startswith("_")}
        self.assertEqual({node.name for node in members}, public)
        functions = [(node, getattr(pimg, node.name)) for node in tree.body if isinstance(node, ast.FunctionDef)]
        functions += [(node, vars(pimg.ProgressiveImage)[node.name]) for node in members if not node.decorator_list]
        for node, function in functions:
            stubbed = [argument.arg for argument in node.args.args + node.args.kwonlyargs]
            real = list(inspect.signature(getattr(pimg.ProgressiveImage, node.name) if node in members else function).parameters)
            self.assertEqual(stubbed, real, node.name)


if __name__ == "__main__":
    unittest.main()
