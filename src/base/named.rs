//! Enumerations whose variants have a name: one row a variant.

/// Declares an enumeration, `ALL` of its variants in the order of their rows, and the function that gives their names:
/// `named! { pub enum Side { Left = "left", Right = "right", } name }`.
#[doc(hidden)]
#[macro_export]
macro_rules! named {
    (
        $(#[$meta:meta])*
        $vis:vis enum $type:ident { $($(#[$of:meta])* $variant:ident = $text:literal,)+ }
        $(#[$about:meta])*
        $name:ident
    ) => {
        $(#[$meta])*
        $vis enum $type { $($(#[$of])* $variant,)+ }

        impl $type {
            /// All of them, in this order.
            pub const ALL: [Self; [$($text),+].len()] = [$(Self::$variant),+];

            $(#[$about])*
            #[must_use]
            pub const fn $name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)+
                }
            }
        }
    };
}

pub(crate) use named;
