"""What the Grasshopper components of shapeop share.

Python 2.7 syntax throughout: it runs under IronPython 2.7 (Rhino 7) and CPython 3.9 (Rhino 8).

    components     one function per component: ports in, ports out
    host           Grasshopper: data trees, messages, the next tick
    live           the published client's loop, the live solver, the one-shot solver
    states         what outlives a tick, and when it is freed
    session        points, signatures and forces in a solver; sends only what changed
    signatures     constraint signatures, settings and forces: made and checked
    indexing       patterns of point indices of a mesh; nearest points
    merging        points closer than a tolerance are one point
    colours        numbers to colours; strain
    solver         one solver of the native library
    library        the native library: found, loaded, declared
    errors         ShapeOpError

Only `solver` and `library` need ctypes, only `host` and `components` need Rhino and Grasshopper.
"""
