//! The secret that a page on another machine has to know.

use crate::{Error, Result};
use std::fmt;

/// 128 random bits, as 32 hexadecimal digits.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Token(String);

impl Token {
    /// A new one.
    ///
    /// # Errors
    /// [`Error::Token`] when the system gives no random bytes.
    pub(crate) fn new() -> Result<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(|error| Error::Token {
            reason: error.to_string(),
        })?;
        Ok(Self(format!("{:032x}", u128::from_be_bytes(bytes))))
    }

    /// Its digits.
    pub(crate) fn digits(&self) -> &str {
        &self.0
    }

    /// Whether `found` is it; how long that takes does not depend on where they differ.
    pub(crate) fn is(&self, found: &str) -> bool {
        let differing = |(a, b): (u8, u8)| a ^ b;
        let differ = self
            .0
            .bytes()
            .zip(found.bytes())
            .map(differing)
            .fold(0, |all, bits| all | bits);
        found.len() == self.0.len() && std::hint::black_box(differ) == 0
    }
}

impl fmt::Debug for Token {
    /// A secret is not printed with what has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_itself_and_nothing_else() {
        let token = Token::new().unwrap();
        assert_eq!(token.digits().len(), 32);
        assert!(token.is(token.digits()));
        assert!(!token.is(""));
        assert!(!token.is(&token.digits()[..31]));
        assert!(!token.is(&format!("{}0", token.digits())));
        assert!(!token.is(Token::new().unwrap().digits()));
        assert_eq!(format!("{token:?}"), "Token");
    }
}
