//! Operators for values in place of references.

/// Defines the operators of a number for values, and for a value and a reference, by those for references.
macro_rules! by_value {
    ($Number:ident: $($Operator:ident $method:ident)*) => { $(
        impl<const LIMBS: usize> $Operator for $Number<LIMBS> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                (&self).$method(&other)
            }
        }
        impl<const LIMBS: usize> $Operator<&Self> for $Number<LIMBS> {
            type Output = Self;
            fn $method(self, other: &Self) -> Self {
                (&self).$method(other)
            }
        }
        impl<const LIMBS: usize> $Operator<$Number<LIMBS>> for &$Number<LIMBS> {
            type Output = $Number<LIMBS>;
            fn $method(self, other: $Number<LIMBS>) -> $Number<LIMBS> {
                self.$method(&other)
            }
        }
    )* };
}

pub(super) use by_value;
