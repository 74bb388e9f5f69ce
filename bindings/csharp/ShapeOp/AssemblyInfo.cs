using System.Reflection;

// As in Cargo.toml: pack.py compares them.
[assembly: AssemblyVersion("0.1.0")]
