# SPDX-License-Identifier: BSD-3-Clause
"""Makes a wheel of the Python module for pip (PEP 517) with CMake and the standard library: what is at hand offline.

    pip install .
    pip install . --config-settings build-dir=build/release     # instead of compiling everything again
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

NAME = "pimg"


def version():
    with open("CMakeLists.txt", encoding="utf-8") as file:
        return re.search(r"project\(pimg VERSION ([0-9.]+)", file.read())[1]


def metadata():
    return (
        f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {version()}\n"
        "Summary: Progressive images for OpenImageIO\nLicense: BSD-3-Clause\n"
        "Requires-Python: >=3.9\nRequires-Dist: numpy\n"
    )


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def compiled(scratch, settings):
    """Builds and installs the module into a folder, and returns that."""
    tree = settings.get("build-dir") or os.path.join(scratch, "build")
    installed = os.path.join(scratch, "installed")
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DPIMG_BUILD_TOOLS=OFF", "-DPIMG_BUILD_TESTS=OFF", "-DPIMG_BUILD_GEGL=OFF"]
    cmake = ["cmake", "-S", ".", "-B", tree, "-DPIMG_BUILD_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}"]
    if not os.path.exists(os.path.join(tree, "CMakeCache.txt")):
        subprocess.run(cmake + options, check=True)
    subprocess.run(["cmake", "--build", tree, "--target", "pimg_python", "--parallel", str(os.cpu_count())], check=True)
    subprocess.run(["cmake", "--install", tree, "--component", "python", "--strip", "--prefix", installed], check=True)
    for folder, _, files in os.walk(installed):
        if "__init__.py" in files:
            return os.path.dirname(folder)
    raise RuntimeError(f"nothing was installed from {tree}")


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = f"{NAME}-{version()}.dist-info"
    os.mkdir(os.path.join(metadata_directory, info))
    with open(os.path.join(metadata_directory, info, "METADATA"), "w", encoding="utf-8") as file:
        file.write(metadata())
    return info


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info = f"{NAME}-{version()}.dist-info"
    name = f"{NAME}-{version()}-{tag()}.whl"
    record = []
    with tempfile.TemporaryDirectory() as scratch, zipfile.ZipFile(
        os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED
    ) as wheel:

        def add(path, data):
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
            record.append(f"{path},sha256={digest},{len(data)}\n")
            wheel.writestr(path, data)

        root = compiled(scratch, config_settings or {})
        package = os.path.join(root, NAME)
        for file in sorted(os.listdir(package)):
            with open(os.path.join(package, file), "rb") as content:
                add(f"{NAME}/{file}", content.read())
        add(f"{info}/METADATA", metadata().encode())
        add(f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode())
        wheel.writestr(f"{info}/RECORD", "".join(record) + f"{info}/RECORD,,\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    """All files that git knows."""
    base = f"{NAME}-{version()}"
    files = subprocess.run(["git", "ls-files"], check=True, capture_output=True, text=True).stdout.splitlines()
    with tarfile.open(os.path.join(sdist_directory, f"{base}.tar.gz"), "w:gz") as archive:
        for file in files:
            archive.add(file, f"{base}/{file}")
    return f"{base}.tar.gz"
