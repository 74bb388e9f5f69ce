//! `_abi.py`: declarations for ctypes, in a syntax that Python 2.7 and 3 share.

use super::{Declarations, Function, Type};

const HEAD: &str = r#""""The C functions of the library, declared for ctypes. Python 2.7 and 3.

Generated from the sources of the library: do not edit. include/shapeop.h documents the functions.
"""

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int, c_uint, c_void_p

"#;

pub(super) fn text(declarations: &Declarations) -> String {
    let mut text = HEAD.to_owned();
    text += &format!("ABI_VERSION = {}\n", declarations.abi_version);
    for each in &declarations.enums {
        text += &format!("\n# {}\n", each.name);
        for (name, number, _) in &each.values {
            text += &format!("{name} = {number}\n");
        }
    }
    for each in &declarations.structs {
        text += &format!("\n\nclass {}(ctypes.Structure):\n    _fields_ = [\n", each.name);
        for field in &each.fields {
            text += &format!("        (\"{}\", {}),\n", field.name, name_of(&field.type_, declarations));
        }
        text += "    ]\n";
    }
    text += "\n\n";
    for callback in &declarations.callbacks {
        let types = std::iter::once(&callback.returns).chain(callback.arguments.iter().map(|each| &each.type_));
        let types: Vec<String> = types.map(|type_| name_of(type_, declarations)).collect();
        text += &format!("{} = CFUNCTYPE({})\n", callback.name, types.join(", "));
    }
    text += "\n# What each function returns, and what it takes.\nFUNCTIONS = {\n";
    for function in &declarations.functions {
        text += &declaration(function, declarations);
    }
    text += "}\n";
    text += r#"

def declare(library):
    """Tells ctypes what the functions of a loaded library take and return."""
    for name, (result, arguments) in FUNCTIONS.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library
"#;
    text
}

fn declaration(function: &Function, declarations: &Declarations) -> String {
    let types = function.arguments.iter().map(|argument| name_of(&argument.type_, declarations));
    let types: Vec<String> = types.collect();
    let result = name_of(&function.returns, declarations);
    let line = format!("    \"{}\": ({result}, [{}]),\n", function.name, types.join(", "));
    if line.len() <= 120 {
        return line;
    }
    let types: String = types.iter().map(|type_| format!("            {type_},\n")).collect();
    format!("    \"{}\": (\n        {result},\n        [\n{types}        ],\n    ),\n", function.name)
}

fn name_of(type_: &Type, declarations: &Declarations) -> String {
    match type_ {
        Type::Void => "None".to_owned(),
        Type::Int => "c_int".to_owned(),
        Type::UnsignedInt => "c_uint".to_owned(),
        Type::Double => "c_double".to_owned(),
        Type::Text => "c_char_p".to_owned(),
        Type::Handle(_) | Type::Anything => "c_void_p".to_owned(),
        Type::Pointer(to) => format!("POINTER({})", name_of(to, declarations)),
        Type::Named(name) if declarations.is_enum(name) => "c_int".to_owned(),
        Type::Named(name) => name.clone(),
    }
}
