#!/usr/bin/env python3
"""Builds the SWIG bindings on Linux: build.py python|java|csharp --prefix DIST --work FOLDER [--package NAME].

DIST is what `cargo xtask dist DIST` made. Into FOLDER go

    python   shapeopPython.py and _shapeopPython.so, for the Python that runs this script
    java     shapeopJava.jar and libshapeopJava.so
    csharp   shapeopCSharp.dll and libshapeopCSharp.so

--package is the Java package or the C# namespace; there is none by default, as in libShapeOp's bindings. Programs are
found on the PATH: swig, cc (or $CC), javac and jar, mcs. Each command is printed before it runs.
"""

import argparse
import glob
import os
import shutil
import subprocess
import sys
import sysconfig

MODULES = {"python": "shapeopPython", "java": "shapeopJava", "csharp": "shapeopCSharp"}


def run(*command):
    print(" ".join(command))
    sys.stdout.flush()
    if subprocess.call(command) != 0:
        sys.exit("build.py: %s failed" % command[0])


def jdk():
    """The folder of the JDK: $JAVA_HOME, or that of the javac on the PATH."""
    if os.environ.get("JAVA_HOME"):
        return os.environ["JAVA_HOME"]
    javac = shutil.which("javac")
    if javac is None:
        sys.exit("build.py: javac is not on the PATH, and JAVA_HOME is not set")
    return os.path.dirname(os.path.dirname(os.path.realpath(javac)))


def include_folders(language):
    """Where the language's own C headers are."""
    if language == "python":
        return [sysconfig.get_paths()["include"], sysconfig.get_paths()["platinclude"]]
    if language == "java":
        return [os.path.join(jdk(), "include"), os.path.join(jdk(), "include", "linux")]
    return []


def main():
    parser = argparse.ArgumentParser(description="Builds the SWIG bindings on Linux.")
    parser.add_argument("language", choices=sorted(MODULES))
    parser.add_argument("--prefix", required=True, help="what `cargo xtask dist` made")
    parser.add_argument("--work", required=True, help="where the products go")
    parser.add_argument("--package", help="Java package or C# namespace")
    options = parser.parse_args()
    language, module = options.language, MODULES[options.language]
    prefix, work = os.path.abspath(options.prefix), os.path.abspath(options.work)

    # Sources of an earlier build must not get into this one.
    sources = os.path.join(work, "swig-" + language)
    shutil.rmtree(sources, ignore_errors=True)
    os.makedirs(sources)

    interface = os.path.join(os.path.dirname(os.path.abspath(__file__)), "shapeop.i")
    wrapper = os.path.join(sources, module + "_wrap.c")
    package = []
    if options.package and language != "python":
        package = ["-package" if language == "java" else "-namespace", options.package]
    compat = "-I" + os.path.join(prefix, "compat")
    run("swig", "-" + language, *package + [compat, "-outdir", sources, "-o", wrapper, interface])

    # The library is found beside the binding, or where it was when this was built.
    library = os.path.join(work, ("_%s.so" if language == "python" else "lib%s.so") % module)
    lib = os.path.join(prefix, "lib")
    includes = ["-I" + folder for folder in [os.path.join(prefix, "include")] + include_folders(language)]
    run(
        os.environ.get("CC", "cc"),
        "-O2",
        "-shared",
        "-fPIC",
        compat,
        *includes + [wrapper, "-L" + lib, "-lshapeop", "-Wl,-rpath,$ORIGIN:" + lib, "-o", library],
    )

    if language == "python":
        shutil.copy(os.path.join(sources, module + ".py"), work)
    elif language == "java":
        classes = os.path.join(sources, "classes")
        run("javac", "-d", classes, *sorted(glob.glob(os.path.join(sources, "*.java"))))
        run("jar", "cf", os.path.join(work, module + ".jar"), "-C", classes, ".")
    else:
        run(
            "mcs",
            "-target:library",
            "-out:" + os.path.join(work, module + ".dll"),
            *sorted(glob.glob(os.path.join(sources, "*.cs"))),
        )


main()
