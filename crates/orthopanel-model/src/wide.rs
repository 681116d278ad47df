//! Loops compiled a second time for the wide registers that the running processor may have.

/// Does `$body` by AVX2 where there is any; arguments are named with their types, in which `'a` is the lifetime of all. What the body
/// calls must be inlined to gain by it. Both give the same numbers: nothing is fused or reordered.
macro_rules! wide {
    (|$($argument:ident: $kind:ty),+ $(,)?| -> $result:ty $body:block) => {{
        struct Work<'a> {
            $($argument: $kind),+
        }
        impl pulp::NullaryFnOnce for Work<'_> {
            type Output = $result;

            #[inline(always)]
            fn call(self) -> $result {
                let Self { $($argument),+ } = self;
                $body
            }
        }
        pulp::Arch::new().dispatch(Work { $($argument),+ })
    }};
}

pub(crate) use wide;
