//! Loops compiled once per instruction set and chosen at run time.
//!
//! [`dispatched!`] wraps a plain function so that its body is compiled with the widest vector unit the
//! processor has. Bodies use explicit `mul_add` and fixed lanes, so every processor gives the same bits;
//! one without fused multiply-add is slower, not different. No `unsafe` of our own is involved.

/// Declares a function whose body is compiled per instruction set. Borrowed arguments take `'a`.
macro_rules! dispatched {
    ($(#[$meta:meta])* $vis:vis fn $name:ident<'a>($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name<'a>($($arg: $ty),*) $(-> $ret)? {
            // A named type instead of a closure: a closure's shim need not be inlined, and then the body
            // would be compiled for the oldest processor.
            struct Kernel<'a> {
                $($arg: $ty,)*
                scope: std::marker::PhantomData<&'a ()>,
            }
            impl<'a> pulp::NullaryFnOnce for Kernel<'a> {
                type Output = $crate::simd::output!($($ret)?);
                #[inline(always)]
                fn call(self) -> Self::Output {
                    let Self { $($arg,)* scope: _ } = self;
                    $body
                }
            }
            pulp::Arch::new().dispatch(Kernel { $($arg,)* scope: std::marker::PhantomData })
        }
    };
}

/// The return type, or `()` where none is written.
macro_rules! output {
    () => {
        ()
    };
    ($ret:ty) => {
        $ret
    };
}

pub(crate) use {dispatched, output};
