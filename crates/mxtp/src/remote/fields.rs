//! What an element has, taken out of it piece by piece, so that what is left is what is not known.

use super::Element;
use super::element::clipped;
use crate::Error;

/// An element of which known attributes and children are taken out.
pub(super) struct Fields(pub(super) Element);

impl Fields {
    /// An attribute, its name in any case.
    pub(super) fn attribute(&mut self, name: &str) -> Option<String> {
        let attributes = &mut self.0.attributes;
        let place = attributes
            .iter()
            .position(|(found, _)| found.eq_ignore_ascii_case(name))?;
        Some(attributes.remove(place).1)
    }

    /// A truth, written in one of the usual ways; `None` where it is not stated.
    pub(super) fn truth(&mut self, name: &'static str) -> Result<Option<bool>, Error> {
        let Some(value) = self.attribute(name) else {
            return Ok(None);
        };
        match value.trim().to_ascii_uppercase().as_str() {
            "TRUE" | "1" | "YES" => Ok(Some(true)),
            "FALSE" | "0" | "NO" => Ok(Some(false)),
            _ => Err(self.mistake(name, "TRUE or FALSE", &value)),
        }
    }

    /// A port, which must be there.
    pub(super) fn port(&mut self, name: &'static str) -> Result<u16, Error> {
        let value = self.needed(name)?;
        let port = value.trim().parse().ok().filter(|port| *port != 0);
        port.ok_or_else(|| self.mistake(name, "a number from 1 to 65535", &value))
    }

    /// An attribute that must be there.
    pub(super) fn needed(&mut self, name: &'static str) -> Result<String, Error> {
        self.attribute(name)
            .ok_or_else(|| self.mistake(name, "a value", "nothing"))
    }

    /// A number, under any of these names, in any case; one that is none is left.
    pub(super) fn number(&mut self, names: &[&str]) -> Option<u32> {
        let attributes = &mut self.0.attributes;
        let is_one = |(name, value): &(String, String)| {
            let named = names.iter().any(|known| known.eq_ignore_ascii_case(name));
            let number = value.trim().parse().ok();
            number.filter(|_| named)
        };
        let (place, number) = attributes
            .iter()
            .enumerate()
            .find_map(|(place, attribute)| Some((place, is_one(attribute)?)))?;
        attributes.remove(place);
        Some(number)
    }

    /// What a child says, as `<Name VALUE="walk"/>` or `<Name>walk</Name>`. A child that says more stays as well.
    pub(super) fn child(&mut self, name: &str) -> Option<String> {
        let children = &mut self.0.children;
        let place = children
            .iter()
            .position(|child| child.name.eq_ignore_ascii_case(name))?;
        let value = said(&children[place]);
        if says_only(&children[place]) {
            children.remove(place);
        }
        Some(value)
    }

    /// What all children of a name say.
    pub(super) fn children(&mut self, name: &str) -> Vec<String> {
        let (named, others): (Vec<_>, Vec<_>) = std::mem::take(&mut self.0.children)
            .into_iter()
            .partition(|child| child.name == name && says_only(child));
        self.0.children = others;
        named.iter().map(said).collect()
    }

    fn mistake(&self, field: &'static str, expected: &'static str, found: &str) -> Error {
        Error::RemoteValue {
            message: clipped(&self.0.name),
            field,
            expected,
            found: clipped(found),
        }
    }
}

fn said(child: &Element) -> String {
    let mut values = child.attributes.iter();
    let value = values.find(|(name, _)| name.eq_ignore_ascii_case(VALUE));
    value.map_or_else(|| child.text.clone(), |(_, value)| value.clone())
}

/// Whether nothing is lost when all that is kept is what it says.
fn says_only(child: &Element) -> bool {
    let is_value = |(name, _): &(String, String)| name.eq_ignore_ascii_case(VALUE);
    let plain = match child.attributes.as_slice() {
        [] => true,
        [only] => is_value(only) && child.text.is_empty(),
        _ => false,
    };
    plain && child.children.is_empty()
}

/// `<Name VALUE="walk"/>`.
pub(super) fn valued(name: &str, value: &str) -> Element {
    Element::new(name).with(VALUE, value)
}

const VALUE: &str = "VALUE";
