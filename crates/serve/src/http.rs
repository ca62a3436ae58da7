//! Connections: how many, how long, how large. Their questions are computed in turns ([`turns`]).
//!
//! Whoever is too slow, too long or too many is refused. Where all places are taken the oldest connection that waits for no answer
//! makes room for a new one, so that clients who keep theirs keep nobody out.

use crate::engine::Engine;
use crate::guard::{self, Refusal};
use crate::longest::longest;
use crate::room::{Asking, Room};
use crate::route::{self, Begun, Reply};
use crate::turns::{self, Turns};
use hadar::error::{Error, Result};
use http_body_util::{BodyExt as _, Full, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::header::{ALLOW, CACHE_CONTROL, CONTENT_TYPE, HeaderValue};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use std::convert::Infallible;
use std::net::TcpListener;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;
use tokio::time::timeout;

/// Questions that wait for their turn; further ones are told to come again.
const WAITING: usize = 256;
/// Time for the head of a request, and for its body.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longest connection.
const LONGEST: Duration = Duration::from_secs(600);
/// Longest head of a request, bytes.
const LONGEST_HEAD: usize = 16 << 10;
/// Longest body of a request, bytes: a scenario and what is changed in it, or a rule.
const LONGEST_BODY: usize = 256 << 10;

/// What a connection is told for which there is no place.
const FULL: &[u8] = b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";

/// What all connections share.
struct Shared {
    engine: Arc<Engine>,
    port: u16,
    turns: Arc<Turns>,
    /// Questions that are computed or wait.
    taken: Semaphore,
}

/// Answers on a listener until the process ends.
///
/// # Errors
/// A listener that is no loopback address, or that the system takes away.
pub fn serve(engine: Engine, listener: TcpListener) -> Result<()> {
    let failed =
        |error: std::io::Error| Error::malformed(format!("cannot listen ({error})"), "try another --port");
    let address = listener.local_addr().map_err(failed)?;
    if !address.ip().is_loopback() {
        return Err(Error::malformed(
            format!("{address} can be reached from other machines"),
            "listen on 127.0.0.1",
        ));
    }
    listener.set_nonblocking(true).map_err(failed)?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let shared = Arc::new(Shared {
        engine: Arc::new(engine),
        port: address.port(),
        turns: Arc::new(Turns::new(cores)),
        taken: Semaphore::new(WAITING),
    });
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_io()
        .enable_time()
        .max_blocking_threads(turns::AT_ONCE)
        .thread_stack_size(hadar::parallel::STACK)
        .build()
        .map_err(failed)?;
    // Taken over within the runtime, by which it is waited for.
    runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener).map_err(failed)?;
        accept(shared, listener).await
    })
}

async fn accept(shared: Arc<Shared>, listener: tokio::net::TcpListener) -> Result<()> {
    let room = Room::default();
    loop {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            // Too many open files, or a client that is gone: later.
            Err(_) => {
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            }
        };
        let Some(place) = room.place() else {
            let _ = stream.try_write(FULL);
            continue;
        };
        let (shared, number, asking) = (Arc::clone(&shared), place.number, Arc::clone(&place.asking));
        let task = tokio::spawn(async move {
            let _place = place;
            let service = service_fn(move |request| {
                let (shared, asking) = (Arc::clone(&shared), Arc::clone(&asking));
                async move {
                    let _asking = Asking::begin(&asking);
                    answer(shared, request).await
                }
            });
            // A client that closes its connection while it waits is gone, and its question with it.
            let connection = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(PATIENCE)
                .half_close(false)
                .max_buf_size(LONGEST_HEAD)
                .serve_connection(TokioIo::new(stream), service);
            // What goes wrong on a connection is that client's own affair.
            let _ = timeout(LONGEST, connection).await;
        });
        room.taken_by(number, task.abort_handle());
    }
}

async fn answer(
    shared: Arc<Shared>,
    request: Request<Incoming>,
) -> std::result::Result<Response<Full<Bytes>>, Infallible> {
    let (head, body) = request.into_parts();
    // A whole address in the place of a path is for proxies.
    let asked = match head.uri.authority() {
        Some(_) => Err(Refusal(StatusCode::BAD_REQUEST, "ask for a path of this page")),
        None => guard::check(shared.port, &head.method, &head.headers),
    };
    let reply = match asked {
        Err(refusal) => Reply::refused(refusal),
        Ok(()) => match head.method {
            Method::GET | Method::HEAD => route::get(head.uri.path(), &shared.engine),
            Method::POST => match read(body).await {
                Ok(body) => compute(shared, head.uri.path().to_owned(), body).await,
                Err(refusal) => Reply::refused(refusal),
            },
            _ => Reply::refused(Refusal(StatusCode::METHOD_NOT_ALLOWED, "GET or POST")),
        },
    };
    Ok(response(reply))
}

async fn read(body: Incoming) -> std::result::Result<Bytes, Refusal> {
    match timeout(PATIENCE, Limited::new(body, LONGEST_BODY).collect()).await {
        Ok(Ok(body)) => Ok(body.to_bytes()),
        Ok(Err(error)) if error.is::<http_body_util::LengthLimitError>() => {
            Err(Refusal(StatusCode::PAYLOAD_TOO_LARGE, "a scenario or a rule has at most 256 KiB here"))
        }
        Ok(Err(_)) => Err(Refusal(StatusCode::BAD_REQUEST, "the request broke off")),
        Err(_) => Err(Refusal(StatusCode::REQUEST_TIMEOUT, "the request took too long")),
    }
}

/// Computes an answer in its turn; a client that goes away before has asked nothing, and its work is stopped.
async fn compute(shared: Arc<Shared>, path: String, body: Bytes) -> Reply {
    let Ok(_taken) = shared.taken.try_acquire() else {
        return Reply::refused(Refusal(StatusCode::SERVICE_UNAVAILABLE, "too many questions at once"));
    };
    // Where the system gives no other thread, this one has the parallel work to do, and nobody may wait for it here.
    if rayon::current_thread_index().is_some() {
        return match route::begun(&path, &body, &shared.engine) {
            Begun::Replied(reply) => reply,
            Begun::Prepared(question) => question.reply(&shared.engine),
        };
    }
    let (longest, command) = longest(&path);
    let longest = shared.engine.limits.time.unwrap_or(longest);
    let taken = turns::taken(Arc::clone(&shared.turns), Arc::clone(&shared.engine), path, body);
    timeout(longest, taken).await.unwrap_or_else(|_| Reply::refused(command.takes_too_long()))
}

/// A reply with what keeps browsers from doing more with it than showing it here.
fn response(reply: Reply) -> Response<Full<Bytes>> {
    let mut response = Response::new(Full::new(reply.body));
    *response.status_mut() = reply.status;
    let headers = response.headers_mut();
    if reply.status == StatusCode::METHOD_NOT_ALLOWED {
        headers.insert(ALLOW, HeaderValue::from_static("GET, HEAD, POST"));
    }
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(reply.kind));
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
    let fixed = [
        (
            "content-security-policy",
            "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; \
             connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        ),
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cross-origin-opener-policy", "same-origin"),
    ];
    for (name, value) in fixed {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}
