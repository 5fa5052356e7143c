//! The page itself, which is part of the program.

use axum::http::HeaderValue;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderName, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::response::{IntoResponse, Response};

/// A file of the page: its path below the root, and its bytes.
type Asset = (&'static str, &'static [u8]);

include!(concat!(env!("OUT_DIR"), "/assets.rs"));

/// The page.
pub(crate) fn index() -> Response {
    asset("/index.html").unwrap_or_else(|| ([(CONTENT_TYPE, HTML)], MISSING).into_response())
}

/// The file of the page at this path, if there is one.
pub(crate) fn asset(path: &str) -> Option<Response> {
    let name = path.strip_prefix('/')?;
    let bytes = bytes(name)?;
    // The names of these have the hash of what they hold.
    let cached = if name.starts_with("assets/") {
        "public, max-age=31536000, immutable"
    } else {
        "no-cache"
    };
    let headers = [(CONTENT_TYPE, media_type(name)), (CACHE_CONTROL, cached)];
    Some((headers, bytes).into_response())
}

/// Gives an answer the headers that keep other sites away from it, and what it loads to this server. Browsers complain of
/// one of them where they do not trust the connection, as plain HTTP to another machine.
pub(crate) fn protect(response: &mut Response, is_trustworthy: bool) {
    let headers = response.headers_mut();
    headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(RESOURCE_POLICY, HeaderValue::from_static("same-origin"));
    if is_trustworthy {
        headers.insert(OPENER_POLICY, HeaderValue::from_static("same-origin"));
    }
    headers
        .entry(CACHE_CONTROL)
        .or_insert(HeaderValue::from_static("no-store"));
}

fn bytes(name: &str) -> Option<&'static [u8]> {
    let found = ASSETS.iter().find(|(known, _)| *known == name)?;
    Some(found.1)
}

fn media_type(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => HTML,
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "json" | "webmanifest" => "application/json",
        "woff2" => "font/woff2",
        _ => "application/octet-stream",
    }
}

const HTML: &str = "text/html; charset=utf-8";
const MISSING: &str = "<!doctype html><meta charset=utf-8><title>posewire</title><p>This build of posewire is without its \
    page: install Node.js 20 or newer, then run <code>cargo clean -p posewire-viewer</code> and build again.";
/// Everything from this server, nothing from elsewhere, and no code made of text.
const POLICY: &str =
    "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");
const OPENER_POLICY: HeaderName = HeaderName::from_static("cross-origin-opener-policy");
