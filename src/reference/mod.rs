//! The float64 twin of every shader function and pass.
