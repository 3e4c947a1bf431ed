//! The functions for walking: exact laws modulo p, and closed forms.

mod contact_derivatives;
