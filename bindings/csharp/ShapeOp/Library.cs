using System;
using System.Collections.Generic;
using System.IO;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>
    /// The native library. It is looked for, once, in this order: the file that the environment variable
    /// <c>SHAPEOP_LIBRARY</c> names, and no other if it is set; <c>runtimes/&lt;rid&gt;/native/</c> beside this assembly or
    /// beside its package; where the runtime looks by itself (beside the program, <c>PATH</c>, <c>LD_LIBRARY_PATH</c>).
    /// </summary>
    /// <remarks>
    /// If it is not found or is of another ABI version, whatever needs it throws a <see cref="DllNotFoundException"/>.
    /// </remarks>
    public static class Library
    {
        const string Variable = "SHAPEOP_LIBRARY";

        /// <summary>The name in the declarations of <see cref="Native"/>.</summary>
        const string ImportName = "shapeop";

        /// <summary>Why the library cannot be used; null if it can.</summary>
        static readonly string Obstacle;

        /// <summary>The path that the declarations are bound to; null: the runtime's own search.</summary>
        static readonly string FoundPath;

        static Library()
        {
            try
            {
                FoundPath = FindPath();
                if (FoundPath != null) Bind();
                int version = AbiVersion();
                if (version != Native.AbiVersion)
                {
                    Obstacle = $"{Where()} has ABI version {version}, this assembly needs {Native.AbiVersion}";
                }
            }
            catch (Exception error)
            {
                Obstacle = $"{Where()} cannot be used: {error.Message}";
            }
        }

        /// <summary>The version of the native library, such as <c>0.1.0</c>.</summary>
        public static string Version
        {
            get { return Call(() => Text.FromLibrary(Native.shapeop_version())); }
        }

        /// <summary>Does nothing if the library can be used.</summary>
        internal static void Require()
        {
            if (Obstacle != null) throw new DllNotFoundException(Obstacle);
        }

        /// <summary>
        /// Calls the library. A function that may be the first to call it goes through here: Mono binds a declaration when
        /// it compiles the method that uses it, and the method of a lambda is compiled when it is called, so not before
        /// the library was found.
        /// </summary>
        internal static T Call<T>(Func<T> body)
        {
            Require();
            return body();
        }

        [MethodImpl(MethodImplOptions.NoInlining)]
        static int AbiVersion()
        {
            return Native.shapeop_abiVersion();
        }

        static string Where()
        {
            return FoundPath != null
                ? $"the library {FoundPath}"
                : $"the library {ImportName} (set {Variable} to its path if it is in no place that is searched)";
        }

        static string FindPath()
        {
            string path = Environment.GetEnvironmentVariable(Variable);
            if (!string.IsNullOrEmpty(path)) return Path.GetFullPath(path);
            foreach (string candidate in PackagePaths())
            {
                if (File.Exists(candidate)) return candidate;
            }
            return null;
        }

        /// <summary>
        /// Where a package keeps it: a host that was built with the package has <c>runtimes/</c> beside the assembly, an
        /// unpacked package has it beside <c>lib/</c>.
        /// </summary>
        static IEnumerable<string> PackagePaths()
        {
            // Empty for an assembly that was loaded from memory.
            string assembly = typeof(Library).Assembly.Location;
            if (string.IsNullOrEmpty(assembly)) yield break;
            string folder = Path.GetDirectoryName(assembly);
            bool isWindows = RuntimeInformation.IsOSPlatform(OSPlatform.Windows);
            bool isMac = RuntimeInformation.IsOSPlatform(OSPlatform.OSX);
            string system = isWindows ? "win" : isMac ? "osx" : "linux";
            string machine = RuntimeInformation.ProcessArchitecture.ToString().ToLowerInvariant();
            string file = isWindows ? "shapeop.dll" : isMac ? "libshapeop.dylib" : "libshapeop.so";
            string inPackage = Path.Combine("runtimes", $"{system}-{machine}", "native", file);
            yield return Path.Combine(folder, inPackage);
            yield return Path.GetFullPath(Path.Combine(folder, "..", "..", inPackage));
        }

        /// <summary>Makes the declarations use <see cref="FoundPath"/>, in the way that the runtime offers.</summary>
        static void Bind()
        {
            if (!File.Exists(FoundPath)) throw new FileNotFoundException("there is no such file");
            Type nativeLibrary = typeof(Marshal).Assembly.GetType("System.Runtime.InteropServices.NativeLibrary");
            if (nativeLibrary != null)
            {
                BindWithResolver(nativeLibrary);
            }
            else if (Type.GetType("Mono.Runtime") != null)
            {
                MapOnMono(IntPtr.Zero, ImportName, null, FoundPath, null);
            }
            else if (LoadOnWindows(FoundPath) == IntPtr.Zero)
            {
                // .NET Framework. A loaded library serves all later loads of its file name.
                throw new DllNotFoundException($"Windows error {Marshal.GetLastWin32Error()}");
            }
        }

        /// <summary>.NET Core 3.0 and later. netstandard2.0 does not know the type, hence the reflection.</summary>
        static void BindWithResolver(Type nativeLibrary)
        {
            MethodInfo set = nativeLibrary.GetMethod("SetDllImportResolver");
            MethodInfo load = nativeLibrary.GetMethod("Load", new[] { typeof(string) });
            MethodInfo resolve = typeof(Library).GetMethod(nameof(Resolve), BindingFlags.Static | BindingFlags.NonPublic);
            loadByPath = (Func<string, IntPtr>)Delegate.CreateDelegate(typeof(Func<string, IntPtr>), load);
            Delegate resolver = Delegate.CreateDelegate(set.GetParameters()[1].ParameterType, resolve);
            set.Invoke(null, new object[] { typeof(Library).Assembly, resolver });
        }

        static Func<string, IntPtr> loadByPath;

        /// <summary>A <c>DllImportResolver</c>.</summary>
        static IntPtr Resolve(string name, Assembly assembly, DllImportSearchPath? search)
        {
            return name == ImportName ? loadByPath(FoundPath) : IntPtr.Zero;
        }

        [DllImport("__Internal", EntryPoint = "mono_dllmap_insert", CharSet = CharSet.Ansi)]
        static extern void MapOnMono(IntPtr image, string name, string function, string targetName, string targetFunction);

        [DllImport("kernel32", EntryPoint = "LoadLibraryW", CharSet = CharSet.Unicode, SetLastError = true)]
        static extern IntPtr LoadOnWindows(string path);
    }
}
