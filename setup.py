"""Builds the extension module, the library and the program by CMake. The environment variable FENESTRA_BUILD names a
build folder in which the target `python` is built already."""

import atexit
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

top = Path(__file__).parent


class CMakeBuild(build_ext):
    def run(self):
        build = os.environ.get("FENESTRA_BUILD")
        if not build:
            build = str(Path(self.build_temp).absolute() / "fenestra")
            subprocess.check_call([
                "cmake", "-S", top, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                "-DCMAKE_UNITY_BUILD_BATCH_SIZE=0", "-DFENESTRA_BUILD_TESTS=OFF", f"-DPython3_EXECUTABLE={sys.executable}",
            ])
            subprocess.check_call(["cmake", "--build", build, "--target", "python"])
        target = Path(self.get_ext_fullpath("fenestra._fenestra")).absolute().parent
        subprocess.check_call(["cmake", "--install", build, "--component", "python", "--prefix", target])


temporary = tempfile.mkdtemp(prefix="fenestra-")  # else setuptools writes into the sources and the folder build
atexit.register(shutil.rmtree, temporary, ignore_errors=True)
setup(
    options={"build": {"build_base": temporary}, "egg_info": {"egg_base": temporary}, "bdist": {"bdist_base": temporary}},
    version=re.search(r"project\(Fenestra VERSION ([0-9.]+)", (top / "CMakeLists.txt").read_text()).group(1),
    ext_modules=[Extension("fenestra._fenestra", [])],
    cmdclass={"build_ext": CMakeBuild},
)
