//! exp, ln, sin and their kind for a whole program: the same bits on every processor.
//!
//! The C library of Linux has several versions of each function, with and without fused multiply-add, and takes the one that the
//! processor has: results differ in the last place, and a report made on one machine is not byte by byte that of another one. A program
//! that links this crate has these functions of `libm` instead, in its own code and in that of everything it is built of (FFT,
//! distributions, matrices): a name that a program defines itself is not looked up in a shared library.
//!
//! Errors of 20 000 random arguments each, against 140 bits: at most 0.9 ulp, atan2 and cosh 1.3, sinh 1.6, tanh 1.9. Rounding, square
//! root, remainder and fused multiply-add are exact anywhere. On other systems than Linux nothing is
//! replaced: what differs there is not known. Programs link it, libraries do not: whose program it is decides.
#![cfg_attr(not(target_os = "linux"), allow(unused))]

macro_rules! replace {
    ($($name:ident: $float:ty, $($argument:ident)+;)+) => {
        $(
            #[cfg(target_os = "linux")]
            #[doc = concat!("`", stringify!($name), "` of the C library.")]
            #[unsafe(no_mangle)]
            pub extern "C" fn $name($($argument: $float),+) -> $float {
                libm::$name($($argument),+)
            }
        )+
    };
}

replace! {
    acos: f64, x;
    acosh: f64, x;
    asin: f64, x;
    asinh: f64, x;
    atan: f64, x;
    atan2: f64, y x;
    atanh: f64, x;
    cbrt: f64, x;
    cos: f64, x;
    cosh: f64, x;
    exp: f64, x;
    exp2: f64, x;
    expm1: f64, x;
    hypot: f64, x y;
    log: f64, x;
    log10: f64, x;
    log1p: f64, x;
    log2: f64, x;
    pow: f64, x y;
    sin: f64, x;
    sinh: f64, x;
    tan: f64, x;
    tanh: f64, x;
    tgamma: f64, x;
    cosf: f32, x;
    expf: f32, x;
    logf: f32, x;
    powf: f32, x y;
    sinf: f32, x;
}

/// `sincos` of the C library, which compilers make of a sine and a cosine of one angle.
#[cfg(target_os = "linux")]
#[unsafe(no_mangle)]
pub extern "C" fn sincos(x: f64, sin: &mut f64, cos: &mut f64) {
    (*sin, *cos) = libm::sincos(x);
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::hint::black_box;

    /// One function as the standard library has it and as it is here.
    type Pair = (&'static str, fn(f64) -> f64, fn(f64) -> f64);

    const PAIRS: [Pair; 19] = [
        ("asin", |x| (x / 11.0).asin(), |x| libm::asin(x / 11.0)),
        ("acos", |x| (x / 11.0).acos(), |x| libm::acos(x / 11.0)),
        ("atan", f64::atan, libm::atan),
        ("atan2", |x| x.atan2(0.7), |x| libm::atan2(x, 0.7)),
        ("cbrt", f64::cbrt, libm::cbrt),
        ("cos", f64::cos, libm::cos),
        ("cosh", f64::cosh, libm::cosh),
        ("exp", f64::exp, libm::exp),
        ("exp2", f64::exp2, libm::exp2),
        ("expm1", f64::exp_m1, libm::expm1),
        ("hypot", |x| x.hypot(0.7), |x| libm::hypot(x, 0.7)),
        ("log", |x| (x + 11.0).ln(), |x| libm::log(x + 11.0)),
        ("log10", |x| (x + 11.0).log10(), |x| libm::log10(x + 11.0)),
        ("log1p", |x| (x + 11.0).ln_1p(), |x| libm::log1p(x + 11.0)),
        ("log2", |x| (x + 11.0).log2(), |x| libm::log2(x + 11.0)),
        ("pow", |x| (x + 11.0).powf(1.7), |x| libm::pow(x + 11.0, 1.7)),
        ("sin and cos", |x| x.sin() + 2.0 * x.cos(), |x| libm::sin(x) + 2.0 * libm::cos(x)),
        ("sinh", f64::sinh, libm::sinh),
        ("tanh", f64::tanh, libm::tanh),
    ];

    /// The C library has other last places for one argument of some hundreds.
    #[test]
    fn the_functions_of_the_program_are_these() {
        for (name, of_std, of_libm) in PAIRS {
            for step in 0..20_000 {
                let x = black_box(f64::from(step).mul_add(1.1e-3, -10.997));
                assert_eq!(of_std(x).to_bits(), of_libm(x).to_bits(), "{name}({x})");
            }
        }
    }

    #[test]
    fn they_are_what_they_are_called() {
        use std::f64::consts::{
            E, FRAC_1_SQRT_2, FRAC_PI_3, FRAC_PI_4, FRAC_PI_6, LN_2, LN_10, LOG2_10, LOG10_2, SQRT_2,
        };
        let close = |name: &str, is: f64, should: f64| {
            assert!((is / should - 1.0).abs() < 4e-16, "{name}: {is:e}, not {should:e}");
        };
        let x = |x: f64| black_box(x);
        close("exp", x(1.0).exp(), E);
        close("expm1", x(1e-12).exp_m1(), 1.000_000_000_000_5e-12);
        close("exp2", x(0.5).exp2(), SQRT_2);
        close("log", x(10.0).ln(), LN_10);
        close("log1p", x(1.0).ln_1p(), LN_2);
        close("log2", x(10.0).log2(), LOG2_10);
        close("log10", x(2.0).log10(), LOG10_2);
        close("pow", x(2.0).powf(-0.5), FRAC_1_SQRT_2);
        close("sin", x(FRAC_PI_6).sin(), 0.5);
        close("cos", x(FRAC_PI_3).cos(), 0.5);
        close("tan", x(FRAC_PI_4).tan(), 1.0);
        close("asin", x(0.5).asin(), FRAC_PI_6);
        close("acos", x(0.5).acos(), FRAC_PI_3);
        close("atan", x(1.0).atan(), FRAC_PI_4);
        close("atan2", x(1.0).atan2(1.0), FRAC_PI_4);
        close("sinh", x(LN_2).sinh(), 0.75);
        close("cosh", x(LN_2).cosh(), 1.25);
        close("tanh", x(LN_2).tanh(), 0.6);
        close("hypot", x(3.0).hypot(4.0), 5.0);
        close("cbrt", x(27.0).cbrt(), 3.0);
    }
}
