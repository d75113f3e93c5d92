# SPDX-License-Identifier: BSD-3-Clause
"""What effects of OpenFX say of themselves, and how they get on with hosts: keys, buttons, colours, stops, mistakes."""

import os
import re
import subprocess
import unittest

import numpy as np

import ofx_host
import pictures


# Scene-linear Rec. 709, and a camera's space: squares of its numbers are light.
CONFIG = """ocio_profile_version: 2
roles: {default: lin, scene_linear: lin}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: raw, colorspace: lin}
colorspaces:
  - !<ColorSpace> {name: lin}
  - !<ColorSpace>
    name: camera
    to_scene_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}
"""


class Hosts(ofx_host.HostTest):
    def parameters(self, effect, *arguments):
        """{name: {property: values as printed}}"""
        found, current = {}, None
        for line in self.host("describe", effect, *arguments).splitlines():
            if line.startswith("parameter "):
                current = found.setdefault(line.split()[1], {"type": line.split()[2]})
            elif current is not None and line.startswith("  "):
                name, _, values = line.strip().partition(":")
                current[name] = values.strip()
        return found

    def test_parameters_are_those_of_the_tables(self):
        parameters = self.parameters("paint")
        self.assertEqual(parameters["opacity"]["OfxParamPropDefault"], "-1", "not given: it is the style's")
        self.assertEqual((parameters["min"]["OfxParamPropMin"], parameters["min"]["OfxParamPropMax"]), ("-1", "1000"))
        self.assertIn("pixels", parameters["min"]["OfxParamPropHint"])
        self.assertNotIn("strokes", parameters, "files are not written by renders")
        words = self.parameters("segment")["output"]["OfxParamPropChoiceEnum"]
        self.assertEqual(words, '"labels" "mean" "boundaries"')
        compress = self.parameters("hdr_compress")
        self.assertEqual(compress["found_dmax"]["OfxParamPropEnabled"], "0")
        self.assertEqual(compress["analyse_shot"]["type"], "OfxParamTypePushButton")

    def test_every_option_is_a_parameter(self):
        usage = subprocess.run([pictures.TOOL, "--help", "--hdr-compress"], capture_output=True, text=True).stdout
        parameters = self.parameters("hdr_compress")
        options = re.findall(r"^\s+(\w+)=", usage, re.MULTILINE)
        self.assertGreater(len(options), 9, usage)
        self.assertEqual([option for option in options if option not in parameters], ["aovs"])  # images have no layers

    def test_depths(self):
        for depth, wanted in (("float", "Float"), ("short", "Short"), ("byte", "Byte"), ("half", "Half")):
            said = self.host("describe", "ink", "--depth", depth)
            self.assertIn(f'OfxImageEffectPropSupportedPixelDepths: "OfxBitDepth{wanted}"\n', said)

    def test_keys(self):
        result = self.render("hdr_compress", "exposure@1=0", "exposure@3=2", "--time", 2)
        self.assertTrue(np.array_equal(result[..., :4], self.tool("hdr_compress", "exposure=1")))

    def test_a_shot(self):
        names = [f"f{i}.exr" for i in range(1, 4)]
        for i, name in enumerate(names):
            ofx_host.write(name, ofx_host.scene(90, 70) * np.array([1, 1, 1, 0]) * (1 + 0.3 * i) + [0, 0, 0, 1])
        self.ok("--frames", "1-3", "--shot-stats:mode=lock:render=0", "shot.json", "f@.exr", "--hdr-compress", "-o",
                "unused#.exr")
        said = self.host("render", "hdr_compress", *names, "out.exr", "--time", 2, "shot_mode=lock", "--press",
                         "analyse_shot", "--show", 1)
        figures = dict(re.findall(r"^(dmax|key|white) = 0 @1:(\S+) @2:\2 @3:\2$", said, re.MULTILINE))
        self.assertEqual(sorted(figures), ["dmax", "key", "white"], said)
        self.assertRegex(said, r"found_s0 = 0\.\d+")
        options = ":".join(f"{name}={value}" for name, value in figures.items())
        expected = self.tool("hdr_compress", options, source="f2.exr")
        self.assertLess(np.abs(pictures.read("out.exr") - expected).max(), 1e-5)
        self.ok("--frames", "2", "--shot-stats:mode=lock", "shot.json", "f@.exr", "--hdr-compress", "-d", "float", "-o",
                "tool@.exr")
        self.assertLess(np.abs(pictures.read("tool2.exr") - expected).max(), 1e-5)

    def test_dark_frames_have_no_keys(self):
        names = [f"f{i}.exr" for i in range(1, 6)]
        for i, name in enumerate(names):
            light = np.array([1, 1, 1, 0]) * (0 if i in (1, 3, 4) else 1 + 0.1 * i)
            ofx_host.write(name, ofx_host.scene(90, 70) * light + [0, 0, 0, 1])
        said = self.host("render", "hdr_compress", *names, "out.exr", "--press", "analyse_shot", "--show", 1)
        self.assertIn("OfxMessageWarning: Analyse shot: nothing is lit in frames 2, 4-5: not measured", said)
        self.assertEqual(re.findall(r"^(dmax|key|white) = 0 @1:\S+ @3:\S+$", said, re.MULTILINE), ["dmax", "key", "white"])
        said = self.host("render", "hdr_compress", "f2.exr", "f4.exr", "out.exr", "--press", "analyse_shot", status=1)
        self.assertIn("nothing is lit in any frame", said)

    def test_cuts_divide_a_shot(self):
        """Frames after a cut are exposed by themselves, as pimgtool does it."""
        names = [f"f{i}.exr" for i in range(1, 9)]
        for i, name in enumerate(names):
            ofx_host.write(name, ofx_host.scene(60, 45) * np.array([1, 1, 1, 0]) * (1 if i < 4 else 20) + [0, 0, 0, 1])
        for words in ((), ("shot_cuts=none",)):
            said = self.host("render", "hdr_compress", *names, "out.exr", "shot_mode=lock", *words, "--press", "analyse_shot",
                             "--show", 1)
            keys = re.search(r"^white = 0 (.*)$", said, re.MULTILINE).group(1).split()
            self.assertEqual(len({key.split(":")[1] for key in keys}), 1 if words else 2, said)

    def test_what_is_found_in_a_frame(self):
        said = self.host("render", "hdr_compress", "in.exr", "out.exr", "--press", "analyse_frame", "--show", 1)
        found = dict(re.findall(r"^found_(\w+) = (\S+)$", said, re.MULTILINE))
        options = ":".join(f"{key}={found[key]}" for key in ("s0", "dmax", "detail", "key", "white"))
        self.assertLess(np.abs(self.tool("hdr_compress", options) - self.tool("hdr_compress")).max(), 1e-5)

    def test_colour_spaces(self):
        for words, space in ((("colour_space=acescg",), "acescg"), (("colour_space=srgb",), "srgb"),
                             (("colour_space=named", "colour_space_name=g24_rec2020"), "g24_rec2020")):
            result = self.render("hdr_compress", *words)
            self.ok("in.exr", f"--build:incolorspace={space}", "--hdr-compress", "-d", "float", "-o", "tool.exr")
            self.assertTrue(np.array_equal(result, pictures.read("tool.exr")), space)

    def test_colour_of_the_host(self):
        """A host that manages colours is asked for scene-linear ones, here ACEScg."""
        said = self.host("render", "hdr_compress", "in.exr", "out.exr", "--manages", 1)
        self.assertIn("output colourspace: 0 OfxColourspace_Source", said)
        self.ok("in.exr", "--build:incolorspace=acescg", "--hdr-compress", "-d", "float", "-o", "tool.exr")
        self.assertTrue(np.array_equal(pictures.read("out.exr"), pictures.read("tool.exr")))
        said = self.host("render", "hdr_compress", "in.exr", "out.exr", "--manages", 1, "colour_space=srgb")
        self.assertIn("output colourspace: 0 lin_rec709_srgb", said)
        said = self.host("render", "segment", "in.exr", "out.exr", "--manages", 1)
        self.assertIn("output colourspace: 0 ofx_raw", said)

    def test_colour_of_a_configuration(self):
        """A host that works with OpenColorIO says which configuration and space; names are those of the configuration."""
        with open("config.ocio", "w", encoding="utf-8") as file:
            file.write(CONFIG)
        words = ("--config", "config.ocio", "--space", "camera")
        said = self.host("render", "hdr_compress", "in.exr", "out.exr", *words)
        self.assertIn("style: OfxImageEffectColourManagementOCIO", said)
        self.assertIn("output colourspace: 0 scene_linear", said)
        self.ok("in.exr", "--build:incolorspace=camera", "--hdr-compress", "-d", "float", "-o", "tool.exr",
                env={"OCIO": "config.ocio"})
        expected = pictures.read("tool.exr")
        self.assertTrue(np.array_equal(pictures.read("out.exr"), expected))
        self.assertFalse(np.array_equal(self.tool("hdr_compress"), expected))
        # The configuration of the host counts, not that of the environment, and only for this host.
        self.host("render", "hdr_compress", "in.exr", "out.exr", "--config", "config.ocio", "colour_space=named",
                  "colour_space_name=camera", environment={"OCIO": "missing.ocio"})
        self.assertTrue(np.array_equal(pictures.read("out.exr"), expected))
        said = self.host("render", "hdr_compress", "in.exr", "out.exr", "colour_space=named", "colour_space_name=camera", status=1)
        self.assertIn("camera", said)
        # One that cannot be read is an error where it is needed.
        said = self.host("render", "hdr_compress", "in.exr", "out.exr", "--config", "missing.ocio", "--space", "camera", status=1)
        self.assertIn("missing.ocio", said)
        self.host("render", "hdr_compress", "in.exr", "out.exr", "--config", "missing.ocio", "colour_space=acescg")

    def test_proxies_look_like_the_whole(self):
        """HDR Compress at half and quarter scale: the mean luminance and the contrast of the full result."""
        ofx_host.write("large.exr", ofx_host.scene(240, 180))
        logs = []
        for scale in (1, 0.5, 0.25):
            result = self.render("hdr_compress", "--scale", scale, source="large.exr")
            logs.append(np.log2(np.maximum(result[..., 1], 1e-3)))
        for log in logs[1:]:
            self.assertLess(abs(log.mean() - logs[0].mean()), 0.15)
            self.assertLess(abs(log.std() - logs[0].std()), 0.15)

    def test_a_stop_is_obeyed(self):
        ofx_host.write("large.exr", ofx_host.scene(700, 500))
        self.host("render", "hdr_compress", "large.exr", "out.exr", "--abort", 30)
        self.assertFalse(np.array_equal(pictures.read("out.exr"), self.tool("hdr_compress", source="large.exr")))

    def test_every_effect_stops_soon(self):
        """At random moments of a build and of a filter. 50 ms are the aim; where other programs want the processors, only
        the middle one of several moments says something."""
        ofx_host.write("large.exr", ofx_host.scene(400, 300))
        for line in self.host("list").splitlines():
            effect = line.split()[0]
            said = self.host("stops", effect, "large.exr", "--moments", 9)
            times = re.findall(r"stopped after (\S+) ms \(median\)", said)
            self.assertEqual(len(times), 2, said)
            self.assertLess(max(map(float, times)), 100, effect + "\n" + said)

    def test_errors_are_messages(self):
        said = self.host("render", "feature_lowpass", "in.exr", "out.exr", "strength=1", "noise=1", status=1)
        self.assertIn("strength and noise both set the cut-off", said)
        said = self.host("render", "paint", "in.exr", "out.exr", "brush=nothing.png", status=1)
        self.assertIn("nothing.png", said)

    def test_numbers_that_are_none(self):
        for value in ("nan", "inf", "-inf", "1e300"):
            for effect, name in (("hdr_compress", "beta"), ("detail_enhance", "gain"), ("paint", "min"), ("ink", "width")):
                done = ofx_host.run("render", effect, "in.exr", "out.exr", f"{name}={value}")
                self.assertIn(done.returncode, (0, 1), done.stderr)
                if done.returncode == 1:
                    self.assertIn(name, done.stderr)
                else:  # the nearer end of the range
                    self.assertTrue(np.isfinite(pictures.read("out.exr")).all(), (effect, name, value))

    def test_hosts_that_do_everything_wrong(self):
        for effect in ("hdr_compress", "segment"):
            self.host("misuse", "in.exr", "--effect", effect)

    def test_nothing_else_is_exported(self):
        library = os.path.join(ofx_host.BUNDLE, "Contents", "Linux-x86-64", "pimg.ofx")
        if not os.path.exists(library):
            self.skipTest("another processor")
        names = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
        names = {line.split()[-1] for line in names.splitlines() if not line.split()[-1].startswith("__")}
        self.assertEqual(names, {"OfxGetNumberOfPlugins", "OfxGetPlugin"})
        needed = subprocess.run(["readelf", "-d", library], capture_output=True, text=True, check=True).stdout
        self.assertNotIn("[libpimg", needed)


if __name__ == "__main__":
    unittest.main()
