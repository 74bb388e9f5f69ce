//! `Native.cs`: declarations for P/Invoke, in C# 7.2 for netstandard2.0.

use super::{Declarations, Field, Function, Type};

const HEAD: &str = "\
// The C functions of the library, declared for P/Invoke.
// Generated from the sources of the library: do not edit. include/shapeop.h documents the functions.

using System;
using System.Runtime.InteropServices;

namespace ShapeOp
{
";

pub(super) fn text(declarations: &Declarations) -> String {
    let mut text = HEAD.to_owned();
    for each in &declarations.enums {
        text += &summary(&each.doc, 1);
        text += &format!("    public enum {}\n    {{\n", pascal(&each.name));
        let prefix = common_prefix(each.values.iter().map(|(name, ..)| name.as_str()));
        for (name, number, doc) in &each.values {
            text += &summary(doc, 2);
            text += &format!("        {} = {number},\n", pascal(&name[prefix..].to_lowercase()));
        }
        text += "    }\n\n";
    }
    text += "    internal static class Native\n    {\n";
    text += &format!("        internal const int AbiVersion = {};\n", declarations.abi_version);
    text += "        private const string Library = \"shapeop\";\n";
    for each in &declarations.structs {
        text += "\n        [StructLayout(LayoutKind.Sequential)]\n";
        text += &format!("        internal struct {}\n        {{\n", each.name);
        for field in &each.fields {
            text += &format!("            internal {} {};\n", stored(&field.type_, declarations), field.name);
        }
        text += "        }\n";
    }
    for callback in &declarations.callbacks {
        text += "\n        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]\n";
        text += &format!("        internal delegate {};\n", signature(callback, declarations));
    }
    for function in &declarations.functions {
        text += "\n        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]\n";
        text += &format!("        internal static extern {};\n", signature(function, declarations));
    }
    text += "    }\n}\n";
    text
}

fn signature(function: &Function, declarations: &Declarations) -> String {
    let argument = |each: &Field| format!("{} {}", passed(function, &each.type_, declarations), camel(&each.name));
    let arguments: Vec<String> = function.arguments.iter().map(argument).collect();
    let result = match &function.returns {
        Type::Void => "void".to_owned(),
        Type::Handle(name) => handle(name),
        other => stored(other, declarations),
    };
    let line = format!("{result} {}({})", function.name, arguments.join(", "));
    if line.len() <= 90 {
        return line;
    }
    format!("{result} {}(\n            {})", function.name, arguments.join(",\n            "))
}

/// A type as a field or a result.
fn stored(type_: &Type, declarations: &Declarations) -> String {
    match type_ {
        Type::Int => "int".to_owned(),
        Type::UnsignedInt => "uint".to_owned(),
        Type::Double => "double".to_owned(),
        Type::Named(name) if declarations.is_enum(name) => pascal(name),
        Type::Named(name) => name.clone(),
        Type::Void | Type::Text | Type::Handle(_) | Type::Anything | Type::Pointer(_) => "IntPtr".to_owned(),
    }
}

/// A type as an argument: arrays are pinned, structs passed by reference, texts are bytes in UTF-8 that end with a zero.
fn passed(function: &Function, type_: &Type, declarations: &Declarations) -> String {
    match type_ {
        Type::Text => "byte[]".to_owned(),
        // What releases a handle has no handle any more.
        Type::Handle(_) if function.name.to_lowercase().ends_with("delete") => "IntPtr".to_owned(),
        Type::Handle(name) => handle(name),
        Type::Pointer(to) => match &**to {
            Type::Named(name) => format!("ref {name}"),
            other => format!("{}[]", stored(other, declarations)),
        },
        other => stored(other, declarations),
    }
}

/// The class that keeps a handle: `ShapeOpSolver` is in a `SolverHandle`.
fn handle(name: &str) -> String {
    format!("{}Handle", name.trim_start_matches("ShapeOp"))
}

/// `<summary>` of a doc comment.
fn summary(doc: &[String], depth: usize) -> String {
    let indent = "    ".repeat(depth);
    let escaped = |line: &String| line.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('`', "");
    let lines: Vec<String> = doc.iter().map(escaped).collect();
    match lines.as_slice() {
        [] => String::new(),
        [line] => format!("{indent}/// <summary>{line}</summary>\n"),
        lines => {
            let inside: String = lines.iter().map(|line| format!("{indent}/// {line}\n")).collect();
            format!("{indent}/// <summary>\n{inside}{indent}/// </summary>\n")
        }
    }
}

/// `shapeop_linear_solver` as `LinearSolver`; `shapeop_err`, which says too little without its prefix, as `ErrorCode`.
fn pascal(name: &str) -> String {
    if name == "shapeop_err" {
        return "ErrorCode".to_owned();
    }
    let words = name.trim_start_matches("shapeop_").split('_');
    words.map(|word| word[..1].to_uppercase() + &word[1..]).collect()
}

/// As a name of an argument; where that is a word of the language, it is marked as a name.
fn camel(name: &str) -> String {
    let pascal = pascal(name);
    let camel = pascal[..1].to_lowercase() + &pascal[1..];
    if ["out", "ref", "in", "params"].contains(&camel.as_str()) { format!("@{camel}") } else { camel }
}

/// The length of what all names begin with, up to a whole word.
fn common_prefix<'a>(names: impl Iterator<Item = &'a str> + Clone) -> usize {
    let first = names.clone().next().unwrap_or_default();
    let is_common = |end: &usize| names.clone().all(|name| name.starts_with(&first[..*end]) && name.len() > *end);
    let ends = first.char_indices().filter(|(_, letter)| *letter == '_').map(|(at, _)| at + 1);
    ends.filter(is_common).last().unwrap_or(0)
}
