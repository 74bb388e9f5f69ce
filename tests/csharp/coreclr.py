"""Runs a .NET program on the CoreCLR of the PyPI package dotnetcore2 (3.1): coreclr.py PROGRAM.exe [ARGUMENT ...]

The package has the runtime only, without an SDK; it runs the same file as Mono. The package itself is not imported:
that would look for libraries to download. Globalization is invariant, as ICU is not there.
"""

import importlib.util
import os
import subprocess
import sys
import tempfile

CONFIGURATION = """{
  "runtimeOptions": {
    "framework": {"name": "Microsoft.NETCore.App", "version": "3.1.0"},
    "configProperties": {"System.Globalization.Invariant": true}
  }
}
"""


def main(arguments):
    if not arguments:
        sys.exit(__doc__)
    package = importlib.util.find_spec("dotnetcore2")
    if package is None:
        sys.exit("dotnetcore2 is not installed in %s: pip install --no-deps dotnetcore2==3.1.23" % sys.executable)
    dotnet = os.path.join(package.submodule_search_locations[0], "bin", "dotnet")
    with tempfile.TemporaryDirectory() as folder:
        configuration = os.path.join(folder, "runtimeconfig.json")
        with open(configuration, "w") as file:
            file.write(CONFIGURATION)
        # Without telemetry pipes and debugger sockets in /tmp.
        environment = dict(os.environ, COMPlus_EnableDiagnostics="0")
        command = [dotnet, "exec", "--runtimeconfig", configuration] + arguments
        return subprocess.run(command, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
