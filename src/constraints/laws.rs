//! The laws that every type keeps, checked over the whole registry.
