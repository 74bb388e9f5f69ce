//! Strips for other programs.
