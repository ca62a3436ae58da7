//! Who may ask: this page and nobody else's.
//!
//! A browser lets any page of the world send requests to a loopback address. Two things tell them apart: the host that the page
//! was asked of (a name of a stranger may be made to point here), and the origin of the page that asks.

use hyper::header::{CONTENT_TYPE, HOST, HeaderMap, HeaderName, ORIGIN};
use hyper::{Method, StatusCode};

/// Why a request is not answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Refusal(pub(crate) StatusCode, pub(crate) &'static str);

const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// Whether a request to this port may be answered.
pub(crate) fn check(port: u16, method: &Method, headers: &HeaderMap) -> Result<(), Refusal> {
    let own = ["127.0.0.1", "localhost", "[::1]"].map(|host| format!("{host}:{port}"));
    let is_own =
        |host: &str| own.iter().any(|own| own.eq_ignore_ascii_case(host)) || (port == 80 && is_bare(host));
    let host = only(headers, &HOST).ok_or(Refusal(StatusCode::BAD_REQUEST, "a request needs one Host"))?;
    if !is_own(host) {
        return Err(Refusal(StatusCode::FORBIDDEN, "this is the page of another host"));
    }
    if headers.contains_key(ORIGIN) {
        let origin = only(headers, &ORIGIN).and_then(|origin| origin.strip_prefix("http://"));
        if !origin.is_some_and(is_own) {
            return Err(Refusal(StatusCode::FORBIDDEN, "only the page itself may ask"));
        }
    }
    if *method != Method::POST {
        return Ok(());
    }
    if headers.contains_key(SITE) && !matches!(only(headers, &SITE), Some("same-origin" | "none")) {
        return Err(Refusal(StatusCode::FORBIDDEN, "only the page itself may ask"));
    }
    // What a form of another page could send without asking is of other types.
    let kind = only(headers, &CONTENT_TYPE).and_then(|kind| kind.split(';').next()).unwrap_or_default();
    if !kind.trim().eq_ignore_ascii_case("application/json") {
        return Err(Refusal(StatusCode::UNSUPPORTED_MEDIA_TYPE, "send application/json"));
    }
    Ok(())
}

/// The value of a header that is there once.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let first = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(first)
}

fn is_bare(host: &str) -> bool {
    ["127.0.0.1", "localhost", "[::1]"].iter().any(|own| own.eq_ignore_ascii_case(host))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyper::header::HeaderValue;

    fn asked(method: Method, headers: &[(&'static str, &'static str)]) -> u16 {
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(*name, HeaderValue::from_static(value));
        }
        check(8731, &method, &map).err().map_or(200, |refusal| refusal.0.as_u16())
    }

    const HERE: (&str, &str) = ("host", "127.0.0.1:8731");
    const JSON: (&str, &str) = ("content-type", "application/json");

    #[test]
    fn the_page_itself_may_ask_and_nobody_else() {
        assert_eq!(asked(Method::GET, &[HERE]), 200);
        assert_eq!(asked(Method::GET, &[("host", "LocalHost:8731")]), 200);
        assert_eq!(asked(Method::POST, &[HERE, JSON]), 200);
        assert_eq!(asked(Method::POST, &[HERE, JSON, ("origin", "http://localhost:8731")]), 200);
        // A name that was made to point here, another port, none, two.
        for host in ["evil.example:8731", "127.0.0.1", "127.0.0.1:80", "127.0.0.1.evil.example:8731", ""] {
            assert_eq!(asked(Method::GET, &[("host", host)]), 403, "{host}");
        }
        assert_eq!(asked(Method::GET, &[]), 400);
        assert_eq!(asked(Method::GET, &[HERE, HERE]), 400);
        for origin in
            ["https://evil.example", "null", "https://127.0.0.1:8731", "http://127.0.0.1:8732", "", "file://"]
        {
            assert_eq!(asked(Method::POST, &[HERE, JSON, ("origin", origin)]), 403, "{origin}");
            assert_eq!(asked(Method::GET, &[HERE, ("origin", origin)]), 403, "{origin}");
        }
        assert_eq!(asked(Method::POST, &[HERE, JSON, ("sec-fetch-site", "cross-site")]), 403);
        assert_eq!(asked(Method::POST, &[HERE, JSON, ("sec-fetch-site", "same-site")]), 403);
        assert_eq!(asked(Method::POST, &[HERE, JSON, ("sec-fetch-site", "same-origin")]), 200);
        assert_eq!(asked(Method::POST, &[HERE, ("content-type", "text/plain")]), 415);
        assert_eq!(asked(Method::POST, &[HERE]), 415);
        assert_eq!(asked(Method::POST, &[HERE, ("content-type", "application/json; charset=utf-8")]), 200);
        // Followed from a letter: a page is shown, nothing is asked.
        assert_eq!(asked(Method::GET, &[HERE, ("sec-fetch-site", "cross-site")]), 200);
    }
}
