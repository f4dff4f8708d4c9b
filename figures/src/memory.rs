//! Asks for memory before a large amount of it is needed, so that a lack of it is an error and not the end of the
//! process.

use crate::outcome::Failure;

/// Checks that the system would give `bytes` more bytes for `what`; `remedy` says how to need less.
///
/// They are freed at once, for the next allocation. A system that overcommits memory can still end the process.
///
/// # Errors
/// The size, what it is for, and the remedy.
pub(crate) fn check(bytes: u64, what: &str, remedy: &str) -> Result<(), Failure> {
    let mut room = Vec::<u8>::new();
    if usize::try_from(bytes).is_ok_and(|bytes| room.try_reserve_exact(bytes).is_ok()) {
        // An allocation that nothing uses may be left out by the compiler.
        std::hint::black_box(&room);
        return Ok(());
    }
    let megabytes = bytes.div_ceil(1_000_000);
    Err(Failure::Failed(format!("cannot get {megabytes} MB of memory for {what}; {remedy}").into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_there_can_be_is_an_error_with_size_and_remedy() {
        assert!(check(0, "nothing", "").is_ok() && check(1 << 20, "a little", "").is_ok());
        for bytes in [1 << 62, u64::MAX] {
            let Err(Failure::Failed(error)) = check(bytes, "a picture", "draw less") else {
                panic!("{bytes} bytes are more than any machine has")
            };
            let megabytes = bytes.div_ceil(1_000_000);
            assert_eq!(error.to_string(), format!("cannot get {megabytes} MB of memory for a picture; draw less"));
        }
    }
}
