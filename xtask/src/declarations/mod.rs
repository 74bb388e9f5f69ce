//! The C functions, structs and enums as other languages declare them, read from the sources of the C ABI.

mod csharp;
mod python;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use syn::{Attribute, Expr, Fields, FnArg, Item, Lit, Meta, ReturnType};

/// The files that declare the C ABI in other languages, with their texts.
pub fn files(sources: &[PathBuf]) -> Result<Vec<(&'static str, String)>> {
    let declarations = Declarations::read(sources)?;
    Ok(vec![
        ("bindings/python/src/shapeop/_abi.py", python::text(&declarations)),
        ("bindings/csharp/ShapeOp/Native.cs", csharp::text(&declarations)),
    ])
}

/// What the sources of the C ABI declare, in their order.
#[derive(Default)]
struct Declarations {
    abi_version: String,
    enums: Vec<Enum>,
    structs: Vec<Struct>,
    callbacks: Vec<Function>,
    functions: Vec<Function>,
}

struct Enum {
    name: String,
    doc: Vec<String>,
    values: Vec<(String, String, Vec<String>)>,
}

struct Struct {
    name: String,
    fields: Vec<Field>,
}

/// A field of a struct, or an argument of a function.
struct Field {
    name: String,
    type_: Type,
}

struct Function {
    name: String,
    arguments: Vec<Field>,
    returns: Type,
}

#[derive(Clone, Debug, PartialEq)]
enum Type {
    Void,
    Int,
    UnsignedInt,
    Double,
    /// `const char *`.
    Text,
    /// `ShapeOpSolver *`, or a pointer to another kind of object.
    Handle(String),
    /// `void *`.
    Anything,
    /// A pointer to one or many.
    Pointer(Box<Type>),
    /// An enum, a struct or a callback.
    Named(String),
}

impl Declarations {
    fn read(sources: &[PathBuf]) -> Result<Self> {
        let mut all = Self::default();
        for source in sources {
            all.read_source(source).with_context(|| format!("{} could not be read", source.display()))?;
        }
        Ok(all)
    }

    fn read_source(&mut self, source: &Path) -> Result<()> {
        for item in syn::parse_file(&fs::read_to_string(source)?)?.items {
            match item {
                Item::Const(item) if item.ident == "SHAPEOP_ABI_VERSION" => self.abi_version = number(&item.expr)?,
                Item::Enum(item) if is_c(&item.attrs) => {
                    let mut values = Vec::new();
                    for value in &item.variants {
                        let (_, expression) = value.discriminant.as_ref().context("an enumerator without a number")?;
                        values.push((value.ident.to_string(), number(expression)?, doc(&value.attrs)));
                    }
                    self.enums.push(Enum { name: item.ident.to_string(), doc: doc(&item.attrs), values });
                }
                Item::Struct(item) if is_c(&item.attrs) => {
                    let Fields::Named(fields) = &item.fields else { bail!("{}: fields without names", item.ident) };
                    let fields = fields.named.iter().map(|field| {
                        let name = field.ident.as_ref().map(ToString::to_string).unwrap_or_default();
                        Ok(Field { name, type_: Type::of(&field.ty)? })
                    });
                    let fields = fields.collect::<Result<_>>()?;
                    self.structs.push(Struct { name: item.ident.to_string(), fields });
                }
                Item::Type(item) => {
                    let function = callback(&item.ty).with_context(|| format!("{} is no callback", item.ident))?;
                    let arguments = function.inputs.iter().map(|argument| {
                        let name = argument.name.as_ref().map(|(name, _)| name.to_string()).unwrap_or_default();
                        Ok(Field { name, type_: Type::of(&argument.ty)? })
                    });
                    self.callbacks.push(Function {
                        name: item.ident.to_string(),
                        arguments: arguments.collect::<Result<_>>()?,
                        returns: Type::returned(&function.output)?,
                    });
                }
                Item::Fn(item) if item.sig.abi.is_some() => {
                    let arguments = item.sig.inputs.iter().map(|argument| {
                        let FnArg::Typed(argument) = argument else { bail!("a function with self") };
                        let syn::Pat::Ident(name) = &*argument.pat else { bail!("an argument without a name") };
                        Ok(Field { name: name.ident.to_string(), type_: Type::of(&argument.ty)? })
                    });
                    self.functions.push(Function {
                        name: item.sig.ident.to_string(),
                        arguments: arguments.collect::<Result<_>>()?,
                        returns: Type::returned(&item.sig.output)?,
                    });
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn is_enum(&self, name: &str) -> bool {
        self.enums.iter().any(|each| each.name == name)
    }
}

impl Type {
    fn of(type_: &syn::Type) -> Result<Self> {
        if let syn::Type::Ptr(pointer) = type_ {
            let to = &*pointer.elem;
            let is_const = pointer.const_token.is_some();
            return Ok(match last_segment(to).as_deref() {
                Some("c_char") if is_const => Self::Text,
                Some(name) if name.starts_with("ShapeOp") => Self::Handle(name.to_owned()),
                Some("c_void") => Self::Anything,
                _ => Self::Pointer(Box::new(Self::of(to)?)),
            });
        }
        Ok(match last_segment(type_).as_deref() {
            Some("c_int") => Self::Int,
            Some("c_uint") => Self::UnsignedInt,
            Some("f64") => Self::Double,
            Some(name) if name.starts_with("shapeop_") => Self::Named(name.to_owned()),
            other => bail!("{other:?} is no type that the bindings know"),
        })
    }

    fn returned(output: &ReturnType) -> Result<Self> {
        match output {
            ReturnType::Default => Ok(Self::Void),
            ReturnType::Type(_, type_) => Self::of(type_),
        }
    }
}

/// The function in `Option<unsafe extern "C" fn(...)>`.
fn callback(type_: &syn::Type) -> Option<&syn::TypeBareFn> {
    let syn::Type::Path(path) = type_ else { return None };
    let syn::PathArguments::AngleBracketed(arguments) = &path.path.segments.last()?.arguments else { return None };
    match arguments.args.first()? {
        syn::GenericArgument::Type(syn::Type::BareFn(function)) => Some(function),
        _ => None,
    }
}

fn last_segment(type_: &syn::Type) -> Option<String> {
    let syn::Type::Path(path) = type_ else { return None };
    path.path.segments.last().map(|segment| segment.ident.to_string())
}

/// True for `repr(C)`, except where there is nothing to see inside.
fn is_c(attributes: &[Attribute]) -> bool {
    let has = |name: &str, word: &str| {
        attributes.iter().any(|attribute| {
            let Meta::List(list) = &attribute.meta else { return false };
            list.path.is_ident(name) && list.tokens.to_string() == word
        })
    };
    has("repr", "C")
}

fn number(expression: &Expr) -> Result<String> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(number) => Ok(number.base10_digits().to_owned()),
            _ => bail!("a number was expected"),
        },
        _ => bail!("a plain number was expected"),
    }
}

/// The lines of a doc comment.
fn doc(attributes: &[Attribute]) -> Vec<String> {
    let mut lines = Vec::new();
    for attribute in attributes {
        let Meta::NameValue(pair) = &attribute.meta else { continue };
        let Expr::Lit(literal) = &pair.value else { continue };
        let Lit::Str(text) = &literal.lit else { continue };
        if pair.path.is_ident("doc") {
            lines.push(text.value().trim().to_owned());
        }
    }
    lines
}
