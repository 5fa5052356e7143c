//! An address as a picture for phones and tablets.

use qrcode::QrCode;
use qrcode::render::unicode::Dense1x2;

/// The code of an address, for a terminal of either colour; `None` for one that is too long.
pub(super) fn code(address: &str) -> Option<String> {
    let code = QrCode::new(address).ok()?;
    // Cameras want dark on light, and most terminals write light on dark.
    let mut picture = code.render::<Dense1x2>();
    Some(picture.dark_color(Dense1x2::Light).light_color(Dense1x2::Dark).build())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_with_a_token_fits_into_a_terminal() {
        let picture = code("http://192.168.100.100:9780/?token=0123456789abcdef0123456789abcdef").unwrap();
        assert!(picture.lines().count() <= 24, "{picture}");
        assert!(picture.lines().all(|line| line.chars().count() <= 48));
    }
}
