//! Who is answered: requests to this host, of its own page, by who has the token.
//!
//! A page of another site can make a browser send requests here, and by a name that it owns and points at this machine it
//! can even read the answers (DNS rebinding). What such a request cannot do is name this server as its host, or come from
//! the server's own origin.

use crate::token::Token;
use axum::http::header::{AUTHORIZATION, COOKIE, HOST, ORIGIN};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, Uri};
use std::net::{IpAddr, SocketAddr};

/// Who is answered.
#[derive(Debug)]
pub(crate) struct Guard {
    listening: SocketAddr,
    token: Option<Token>,
}

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// It names another host.
    Host,
    /// It is of another origin's page, or does not say of which.
    Origin,
    /// It lacks the token.
    Token,
}

impl Guard {
    /// A guard of the server that listens there.
    pub(crate) fn new(listening: SocketAddr, token: Option<Token>) -> Self {
        Self { listening, token }
    }

    /// The token, where one is needed.
    pub(crate) fn token(&self) -> Option<&Token> {
        self.token.as_ref()
    }

    /// The name of the cookie that holds the token: cookies are shared by all ports of a host.
    pub(crate) fn cookie(&self) -> String {
        format!("posewire-{}", self.listening.port())
    }

    /// Checks that a request names this host, once; also where it asks for a whole address instead of a path.
    ///
    /// # Errors
    /// [`Refusal::Host`] when it does not.
    pub(crate) fn check_host(&self, asked: &Uri, headers: &HeaderMap) -> Result<(), Refusal> {
        let host = only(headers, &HOST).ok_or(Refusal::Host)?;
        let asked = asked.authority().map_or(host, Authority::as_str);
        let is_ours = self.is_ours(host) && self.is_ours(asked);
        is_ours.then_some(()).ok_or(Refusal::Host)
    }

    /// Whether a request names this machine, which browsers trust without encryption.
    pub(crate) fn is_of_this_machine(headers: &HeaderMap) -> bool {
        let named = only(headers, &HOST).and_then(split_port);
        named.is_some_and(|(name, _)| match address(name) {
            Some(address) => address.is_loopback(),
            None => name.eq_ignore_ascii_case("localhost"),
        })
    }

    /// Checks that a request whose host is right comes from this server's page, where it says or has to say from which.
    ///
    /// # Errors
    /// [`Refusal::Origin`] when it does not.
    pub(crate) fn check_origin(headers: &HeaderMap, required: bool) -> Result<(), Refusal> {
        if !headers.contains_key(ORIGIN) {
            return if required { Err(Refusal::Origin) } else { Ok(()) };
        }
        let origin = only(headers, &ORIGIN).and_then(|origin| origin.strip_prefix("http://"));
        let host = only(headers, &HOST);
        let is_same = origin
            .zip(host)
            .is_some_and(|(origin, host)| origin.eq_ignore_ascii_case(host));
        is_same.then_some(()).ok_or(Refusal::Origin)
    }

    /// Checks that a request has the token, as a cookie or as `Authorization: Bearer`.
    ///
    /// # Errors
    /// [`Refusal::Token`] when it does not.
    pub(crate) fn check_token(&self, headers: &HeaderMap) -> Result<(), Refusal> {
        let Some(token) = &self.token else { return Ok(()) };
        let bearer = only(headers, &AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
        let name = self.cookie();
        let cookies = headers.get_all(COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut pairs = cookies
            .flat_map(|cookies| cookies.split(';'))
            .filter_map(|pair| pair.trim().split_once('='));
        let has =
            bearer.is_some_and(|found| token.is(found)) || pairs.any(|(key, value)| key == name && token.is(value));
        has.then_some(()).ok_or(Refusal::Token)
    }

    fn is_ours(&self, host: &str) -> bool {
        let named = split_port(host);
        named.is_some_and(|(name, port)| port == self.listening.port() && self.is_named(name))
    }

    /// Whether a host's name is one of this server's. Another site owns names and no addresses: any address that leads
    /// here is good where the server listens on all of them.
    fn is_named(&self, name: &str) -> bool {
        match address(name) {
            Some(address) => {
                let listening = self.listening.ip().to_canonical();
                address.is_loopback() || address == listening || listening.is_unspecified()
            }
            None => name.eq_ignore_ascii_case("localhost"),
        }
    }
}

/// The address that a host is named by, if it is one.
fn address(name: &str) -> Option<IpAddr> {
    let address = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
    address.ok().map(|address| address.to_canonical())
}

/// The value of a header that is there once and is text.
fn only<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

/// A host and its port, which is 80 where none is given.
fn split_port(host: &str) -> Option<(&str, u16)> {
    let in_name = host.rfind(']').unwrap_or(0);
    match host[in_name..].rfind(':') {
        None => Some((host, 80)),
        Some(colon) => {
            let (name, port) = (&host[..in_name + colon], &host[in_name + colon + 1..]);
            let is_number = !port.is_empty() && port.bytes().all(|byte| byte.is_ascii_digit());
            is_number.then(|| port.parse().ok()).flatten().map(|port| (name, port))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        let mut headers = HeaderMap::new();
        for (name, value) in pairs {
            headers.append(*name, HeaderValue::from_str(value).unwrap());
        }
        headers
    }

    fn guard(listening: &str) -> Guard {
        Guard::new(listening.parse().unwrap(), None)
    }

    #[test]
    fn only_names_of_this_server_are_hosts() {
        for (listening, host, is_good) in [
            ("127.0.0.1:9780", "127.0.0.1:9780", true),
            ("127.0.0.1:9780", "localhost:9780", true),
            ("127.0.0.1:9780", "LocalHost:9780", true),
            ("127.0.0.1:9780", "[::1]:9780", true),
            ("[::1]:9780", "[::1]:9780", true),
            ("127.0.0.1:80", "localhost", true),
            ("127.0.0.1:9780", "localhost", false),
            ("127.0.0.1:9780", "localhost:9781", false),
            ("127.0.0.1:9780", "localhost:", false),
            ("127.0.0.1:9780", "localhost:+9780", false),
            ("127.0.0.1:9780", "localhost:9780:9780", false),
            ("127.0.0.1:9780", "localhost.evil.example:9780", false),
            ("127.0.0.1:9780", "evil.example:9780", false),
            ("127.0.0.1:9780", "10.0.0.5:9780", false),
            ("127.0.0.1:9780", "]:9780", false),
            ("127.0.0.1:9780", "", false),
            ("10.0.0.5:9780", "10.0.0.5:9780", true),
            ("10.0.0.5:9780", "10.0.0.6:9780", false),
            ("0.0.0.0:9780", "10.0.0.6:9780", true),
            ("0.0.0.0:9780", "[::ffff:10.0.0.6]:9780", true),
            ("0.0.0.0:9780", "evil.example:9780", false),
        ] {
            let found = guard(listening).check_host(&Uri::from_static("/"), &headers(&[("host", host)]));
            assert_eq!(found.is_ok(), is_good, "{listening} {host}");
        }
    }

    #[test]
    fn a_host_is_named_once() {
        let guard = guard("127.0.0.1:9780");
        let path = Uri::from_static("/");
        assert_eq!(guard.check_host(&path, &headers(&[])), Err(Refusal::Host));
        let twice = headers(&[("host", "localhost:9780"), ("host", "localhost:9780")]);
        assert_eq!(guard.check_host(&path, &twice), Err(Refusal::Host));
    }

    #[test]
    fn a_whole_address_is_of_this_host_too() {
        let guard = guard("127.0.0.1:9780");
        let ours = headers(&[("host", "localhost:9780")]);
        for (asked, is_good) in [
            ("http://localhost:9780/", true),
            ("http://127.0.0.1:9780/api/scene", true),
            ("http://evil.example:9780/", false),
            ("http://evil@localhost:9780/", false),
            ("http://localhost/", false),
        ] {
            let found = guard.check_host(&Uri::from_static(asked), &ours);
            assert_eq!(found.is_ok(), is_good, "{asked}");
        }
    }

    #[test]
    fn browsers_trust_this_machine_alone_without_encryption() {
        for (host, is_trusted) in [
            ("localhost:9780", true),
            ("127.0.0.1:9780", true),
            ("[::1]:9780", true),
            ("10.0.0.5:9780", false),
            ("studio-pc:9780", false),
        ] {
            assert_eq!(
                Guard::is_of_this_machine(&headers(&[("host", host)])),
                is_trusted,
                "{host}"
            );
        }
    }

    #[test]
    fn an_origin_is_the_host_of_the_request() {
        for (origin, is_good) in [
            ("http://localhost:9780", true),
            ("http://LOCALHOST:9780", true),
            ("http://127.0.0.1:9780", false),
            ("https://localhost:9780", false),
            ("http://localhost:9781", false),
            ("http://evil.example", false),
            ("null", false),
            ("", false),
        ] {
            let headers = headers(&[("host", "localhost:9780"), ("origin", origin)]);
            for required in [false, true] {
                assert_eq!(Guard::check_origin(&headers, required).is_ok(), is_good, "{origin}");
            }
        }
        let without = headers(&[("host", "localhost:9780")]);
        assert_eq!(Guard::check_origin(&without, false), Ok(()));
        assert_eq!(Guard::check_origin(&without, true), Err(Refusal::Origin));
    }

    #[test]
    fn a_token_comes_as_a_cookie_or_by_name() {
        let token = Token::new().unwrap();
        let digits = token.digits().to_owned();
        let guard = Guard::new("0.0.0.0:9780".parse().unwrap(), Some(token));
        let good = [
            ("cookie", format!("posewire-9780={digits}")),
            ("cookie", format!("a=b; posewire-9780={digits}; c")),
            ("authorization", format!("Bearer {digits}")),
        ];
        for (name, value) in good {
            assert_eq!(
                guard.check_token(&headers(&[(name, &value)])),
                Ok(()),
                "{name}: {value}"
            );
        }
        let bad = [
            ("cookie", format!("posewire-9781={digits}")),
            ("cookie", "posewire-9780=".to_owned()),
            ("cookie", format!("posewire-9780={}", digits.replace(&digits[..1], "x"))),
            ("authorization", digits.clone()),
        ];
        for (name, value) in bad {
            let found = guard.check_token(&headers(&[(name, &value)]));
            assert_eq!(found, Err(Refusal::Token), "{name}: {value}");
        }
        assert_eq!(guard.check_token(&HeaderMap::new()), Err(Refusal::Token));
    }
}
